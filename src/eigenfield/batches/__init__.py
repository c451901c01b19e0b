"""Many captures in one command: each encoded and measured, one table, one page."""

from eigenfield.batches.run import BatchResult, batch

__all__ = ["BatchResult", "batch"]
