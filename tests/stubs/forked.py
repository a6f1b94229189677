"""End of a forked process that acts as a process of its own."""

import atexit
import os
import sys
import threading


def end_with(work, tell=lambda code: None):
    """Call a function that may raise SystemExit, report its exit code, and end the process."""
    code = 1
    try:
        work()
        code = 0
    except SystemExit as ended:
        code = ended.code if isinstance(ended.code, int) else 1 if ended.code else 0
        if isinstance(ended.code, str):
            print(ended.code, file=sys.stderr)
    except BaseException:
        sys.excepthook(*sys.exc_info())
    finally:
        threading._shutdown()
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        tell(code)
        os._exit(code)
