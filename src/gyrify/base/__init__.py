"""What everything else stands on: arguments, compiled code, processes, optional packages, versions."""
