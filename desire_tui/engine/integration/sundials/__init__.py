"""SUNDIALS' CVODE, driven through its C interface from the libraries inside scikit-sundae's wheel."""
