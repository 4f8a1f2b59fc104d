"""
What this library costs beside others, measured in one process and one run: `make bench`.

`rivals/` has one file per library, `single_call`, `batch` and `growth` measure, `report` writes
docs/benchmarks.md. Nothing in a report is typed in: it is rendered from what a run measured.

"""
