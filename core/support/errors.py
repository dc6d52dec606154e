"""What is wrong with an input, in one sentence."""


class ReflectionError(ValueError):
    """The input cannot give a reflection; the message is one sentence for the user."""
