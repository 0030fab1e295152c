"""Hours of editing and running in one process, which must end as it began."""
