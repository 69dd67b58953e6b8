"""Gears: trains by their relations and by Willis, torques and losses, assembly, teeth."""
