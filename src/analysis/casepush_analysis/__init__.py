"""Headless analysis of casepush recordings.

bag.py reads a bag into the plain records of records.py; metrics.py and calibration.py turn records
into numbers; figures/, tables.py and report.py write them down. Only bag.py,
salvage.py, builder.py and conversions.py know of bags and messages.
"""
