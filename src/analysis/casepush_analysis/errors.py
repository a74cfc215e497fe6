"""The one error that a user can cause."""


class InputError(Exception):
    """Bad input: one clear line saying where and what."""
