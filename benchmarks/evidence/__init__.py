"""The whole evaluation, one idea a module; `benchmarks/report.py` runs it."""
