"""The motion of the table: waveforms, and waveforms from records."""
