"""docs/tutorial.md as a session: its commands run, and their output is put into the page."""
