"""Finds where characters, cloth and props go through each other and themselves, frame by frame."""
