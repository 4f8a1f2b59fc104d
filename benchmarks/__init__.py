"""
Times of this library and of others, measured in one process and one run: `make bench`.

`libraries/` has one file per library; `single_call`, `batch` and `scaling` measure; `report`
renders docs/benchmarks.md from the results alone.

"""
