"""Runs in lock step: one lane of vector code for each run (`passes.replication` says what differs)."""
