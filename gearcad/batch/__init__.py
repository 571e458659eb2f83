"""Design tables: every row a design, made in parallel processes, and one table of results.

table.py (spec)  ->  run.py: check all rows, make them, write the results
                       pool.py     threads here or on a Dask cluster
                       worker.py   a process of its own for each thread
                       row.py      one row: what is missing of it, made and published
                       manifest.py what a finished folder holds, of which inputs

"""

from gearcad.batch.results import Decimal
from gearcad.batch.run import Progress, Summary, run_table
from gearcad.batch.steps import Step, Wanted

__all__ = ["Decimal", "Progress", "Step", "Summary", "Wanted", "run_table"]
