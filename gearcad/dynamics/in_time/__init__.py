"""Trains and pairs in time, at any course of speed and torque: steps that are exact for modes, implicit for teeth. SI units."""
