# SPDX-License-Identifier: Apache-2.0
# Sourced by bench/run.sh and tests/run.sh.

# need_packages FILE: installs the Debian packages that FILE names, one a line, and that are not
# there yet. Asks for root only when something is missing.
need_packages()
{
    missing=
    for package in $(sed 's/#.*//' "$1"); do
        dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q '^install ok installed$' ||
            missing="$missing $package"
    done
    if [ -z "$missing" ]; then
        return 0
    fi
    root=
    if [ "$(id -u)" -ne 0 ]; then
        root=sudo
    fi
    echo "installing:$missing"
    # The list is split into words on purpose.
    # shellcheck disable=SC2086
    $root apt-get update -qq &&
        $root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
            $missing </dev/null >/dev/null
}
