# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""TOML text as dictionaries, also before Python 3.11."""


def loads(text):
    """The tables of a text. Raises ImportError, which names what is needed."""
    try:
        import tomllib
    except ImportError:
        try:
            import tomli as tomllib
        except ImportError:
            raise ImportError("Python 3.11 or the package tomli") from None
    return tomllib.loads(text)
