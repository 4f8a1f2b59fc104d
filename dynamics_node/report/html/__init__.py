"""
The model report as a page: one file with tables, plots and a 3D view of the robot.

What may change here: how the report is shown, not its content. The page requests nothing from the
network. Jinja2 escapes every text in the templates; `plots.plot_text` escapes texts for plotly.

"""

from .page import page, write_html

__all__ = ['page', 'write_html']
