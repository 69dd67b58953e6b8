"""Gradients of the reference: derivatives of motion and forces by lengths, angles and masses."""
