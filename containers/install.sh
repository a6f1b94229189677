#!/bin/sh
# Install microslip with its workflow: the only build step of both container definitions.
#
#     containers/install.sh SOURCE PREFIX
#
# SOURCE: folder of the repository. PREFIX: virtual environment to create.
set -eu
python3 -m venv "$2"
"$2/bin/pip" install --no-cache-dir --disable-pip-version-check "$1[workflow]"
"$2/bin/microslip" --version
