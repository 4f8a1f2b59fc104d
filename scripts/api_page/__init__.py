"""docs/api.md, rendered from the public names of the library and their docstrings."""
