"""
The model report in a terminal.

What may change here: how the report is shown to people who read it in a terminal, or in the log of
a CI. What is shown is decided one room up.

"""

from .summary import print_report

__all__ = ['print_report']
