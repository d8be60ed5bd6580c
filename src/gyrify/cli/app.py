"""The application: collects the commands and turns errors into exit codes.

A command lives in a module of its own, takes plain values, imports what is heavy inside its function and
returns its exit code (None is 0). It prints its one JSON document last.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from cyclopts import App, Parameter
from cyclopts.exceptions import CycloptsError

from gyrify import __version__
from gyrify.cli import config, presets
from gyrify.cli import run as run_commands
from gyrify.cli.animate import animate
from gyrify.cli.codes import COMPLETED, FAILED, INTERRUPTED, USAGE
from gyrify.cli.converge import converge
from gyrify.cli.early import ignore_interrupts
from gyrify.cli.environment import restore_docstrings, tidy_environment
from gyrify.cli.interrupts import ends_are_interrupts
from gyrify.cli.overrides import STANDARD_INPUT
from gyrify.cli.paper import paper
from gyrify.cli.plot import plot
from gyrify.cli.report import report
from gyrify.cli.stored import export, verify
from gyrify.cli.streams import complain, print_json
from gyrify.cli.study import study
from gyrify.cli.table import table
from gyrify.cli.threshold import threshold
from gyrify.errors import ConfigError, GyrifyError, HistoryError, MeshError

for _name in [name for name in sys.modules if name.startswith("gyrify.cli.")]:
    restore_docstrings(sys.modules[_name])

app = App(
    name="gyrify",
    help="Simulate how the cerebral cortex folds.",
    version=__version__,
    default_parameter=Parameter(negative=(), show_default=False),
    result_action="return_value",
    suppress_keyboard_interrupt=False,
)
app.command(run_commands.run)
app.command(run_commands.resume)
app.command(verify)
app.command(threshold)
app.command(converge)
app.command(study)
app.command(table)
app.command(paper)
app.command(export)
app.command(report)
app.command(plot)
app.command(animate)
app.command(presets.presets)
app.command(config.app)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows ``gyrify``; by default the arguments of the process.

    Returns
    -------
    int
        0 completed, 1 failed, 2 usage or configuration, 3 stopped by a limit, 130 interrupted.
    """
    if arguments is None:
        tidy_environment()
    given = sys.argv[1:] if arguments is None else arguments
    tokens = [str(STANDARD_INPUT) if token == "-" else token for token in given]
    try:
        with ends_are_interrupts():
            code = app(tokens, exit_on_error=False, print_error=False)
        sys.stdout.flush()
        return code if isinstance(code, int) else COMPLETED
    except CycloptsError as error:
        return _report(ConfigError(" ".join(str(error).split()), "See gyrify --help."), tokens)
    except GyrifyError as error:
        return _report(error, tokens)
    except KeyboardInterrupt:
        complain("Interrupted.")
        if "--json" in tokens:
            print_json({"error": "Interrupted", "message": "Interrupted.", "advice": "Run it again."})
        return INTERRUPTED
    except MemoryError:
        return _report(GyrifyError("Memory ran out.", "Use a smaller mesh, or fewer workers."), tokens)
    except BrokenPipeError:  # the reader of a pipe has left
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return COMPLETED
    except OSError as fault:
        from gyrify.config.words import shorten

        what = f"{shorten(str(fault.filename or 'A file'), 120)}: {fault.strerror or fault}."
        return _report(HistoryError(what, "Check the path, its permissions and the disk."), tokens)
    finally:
        if arguments is None:  # all is done: an interrupt now would only garble the end of the process
            ignore_interrupts()


def _report(error: GyrifyError, tokens: Sequence[str]) -> int:
    """Say an error on stderr and, where JSON was asked for, on stdout too; return the exit code."""
    complain(str(error))
    if "--json" in tokens:
        print_json({"error": type(error).__name__, "message": error.message, "advice": error.advice})
    return USAGE if isinstance(error, ConfigError | HistoryError | MeshError) else FAILED
