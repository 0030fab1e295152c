"""Every problem of a program that can be found before it runs."""
