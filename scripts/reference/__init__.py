"""docs/reference.md, rendered from the code, the interface files and the launch files."""
