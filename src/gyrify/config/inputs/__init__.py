"""Files that describe a body: found, read, checked and repaired."""
