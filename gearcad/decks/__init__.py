"""Input of other finite element programs that runs as it is: loaded pairs, and single loaded teeth."""
