"""Which level of modelling is enough for a train: its models held against the finest of them, and what decides."""
