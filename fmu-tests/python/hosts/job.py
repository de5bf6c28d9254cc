"""What all hosts have in common: a job comes as JSON, the results go out as JSON, and a host that is not here says so."""

import importlib
import json
import sys

# Exit status that means "cannot be tried here", as in automake; the reason is on stderr.
NOT_HERE = 77


def host(module):
    """The host's Python module, or an end with NOT_HERE."""
    try:
        return importlib.import_module(module)
    # A missing package is an ImportError, a library that does not load an OSError.
    except (ImportError, OSError) as problem:
        print(f"{module} cannot be loaded: {problem}", file=sys.stderr)
        sys.exit(NOT_HERE)


def read():
    """The job: see `run` in test_hosts.py."""
    with open(sys.argv[1], encoding="utf-8") as file:
        return json.load(file)


def write(results):
    """Results: {instance: {variable: [value after each step]}}."""
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        json.dump(results, file)
