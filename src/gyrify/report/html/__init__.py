"""Reports of runs and studies: one HTML file each, which needs nothing but a browser."""

from gyrify.report.html.assembly import write_page
from gyrify.report.html.page_of_run import run_page

__all__ = ["run_page", "write_page"]
