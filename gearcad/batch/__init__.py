"""Design tables: every row a design, made in parallel processes, and one table of results.

table.py (designs)  ->  run.py: check all rows, make them, write the results
                       pool.py     threads here or on a Dask cluster
                       worker.py   a process of its own for each thread
                       row.py      one row: what is missing of it, made and published
                       stages.py   the jobs that a row does, and the parts that they make
                       manifest.py what a finished folder holds, of which inputs

"""

from gearcad.batch.run import BatchSummary, InterruptedRunError, run_table
from gearcad.designs.cells import Decimal

__all__ = ["BatchSummary", "Decimal", "InterruptedRunError", "run_table"]
