"""The whole actuator in time: motor, drive, gearbox, thermal network, loads."""
