"""
The model report as a page: one file with tables, plots and a robot that can be turned.

What may change here: how the report is shown. What is shown is decided one room up. The page asks
the network for nothing; everything from a description goes through `escape`.

"""

from .document import page, write_html

__all__ = ['page', 'write_html']
