"""docs/tutorial.md as a session: its commands run, and what they print stands on the page."""
