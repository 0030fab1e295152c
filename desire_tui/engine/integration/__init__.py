"""Integration rules as data, and CVODE by function pointer."""
