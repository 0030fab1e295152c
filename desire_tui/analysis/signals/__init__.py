"""What a run's samples say as signals: spectra, distributions, averages."""
