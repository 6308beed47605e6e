"""Pneumatic morphing wings with pantographic ribs on FEniCSx."""
