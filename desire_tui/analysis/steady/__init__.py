"""`steady`: steady states, their eigenvalues and kinds."""
