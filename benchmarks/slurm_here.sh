#!/usr/bin/env bash
# Run the small sweep with and without Slurm, and compare datasets and batches byte for byte. This
# machine is Slurm's only node.
#
#     benchmarks/slurm_here.sh [--markdown FILE]
#
# If run by root, this script installs the Debian packages slurm-wlm and munge if they are missing.
# The extra `slurm` of this package is installed into the environment of .venv/bin/snakemake, or of
# the snakemake in the variable SNAKEMAKE. Slurm runs in a temporary folder on separate ports,
# without systemd, accounting and cgroups, and is stopped and removed at the end. An existing Slurm
# is not changed. The exit code is 0 if all files are equal, 1 if not, and 2 if a requirement is
# missing.
set -euo pipefail

refuse() {
    echo "$1" >&2
    exit 2
}

markdown=
if [ "${1-}" = --markdown ] && [ $# -eq 2 ]; then
    markdown=$(realpath "$2")
elif [ $# -gt 0 ]; then
    refuse "usage: benchmarks/slurm_here.sh [--markdown FILE]"
fi
snakemake=${SNAKEMAKE:-$(dirname "$0")/../.venv/bin/snakemake}
snakemake=$(realpath -s "$(command -v "$snakemake" || echo "$snakemake")")
[ -x "$snakemake" ] || refuse "$snakemake is missing: install as README.md says, or set SNAKEMAKE"
python=$(dirname "$snakemake")/python
cd "$(dirname "$0")/.."

# Requirements

programs=(slurmctld slurmd sbatch srun squeue sinfo scontrol scancel munged mungekey)
PATH=$PATH:/usr/sbin
if ! type "${programs[@]}" >/dev/null 2>&1; then
    [ "$(id -u)" -eq 0 ] || refuse "missing; as root: apt-get install slurm-wlm munge"
    apt-get update -qq >&2
    export DEBIAN_FRONTEND=noninteractive
    apt-get install -y -qq --no-install-recommends slurm-wlm munge >&2
fi
"$python" -c "import snakemake_executor_plugin_slurm" 2>/dev/null ||
    "$python" -m pip install --quiet --disable-pip-version-check -e ".[slurm]"

# Slurm in a temporary folder

work=$(mktemp -d)
daemons=()
stop() {
    trap - EXIT
    if [ ${#daemons[@]} -gt 1 ]; then
        scancel --quiet --state=PENDING,RUNNING --user="$(id -un)" 2>/dev/null || true
        for _ in $(seq 50); do
            [ -n "$(squeue --noheader --states=RUNNING,COMPLETING 2>/dev/null)" ] || break
            sleep 0.2
        done
    fi
    # Stop in reverse order of the start: slurmd, slurmctld, munged.
    for ((i = ${#daemons[@]} - 1; i >= 0; i--)); do
        kill "${daemons[i]}" 2>/dev/null || true
        wait "${daemons[i]}" 2>/dev/null || true
    done
    rm -rf "$work"
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

in_background() { # log, command and its arguments
    local log=$work/$1
    shift
    "$@" >"$log" 2>&1 </dev/null &
    daemons+=($!)
}

chmod 755 "$work"
mkdir -m 755 "$work/munge"
mkdir "$work/state" "$work/spool"
mungekey --create --keyfile="$work/munge/key"
chmod 400 "$work/munge/key"
cpus=$(nproc)
memory=$(awk '/MemAvailable/ {print int($2 / 1024)}' /proc/meminfo)
read -r control_port node_port < <("$python" -c '
import socket
sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
print(*(each.getsockname()[1] for each in sockets))')
export SLURM_CONF=$work/slurm.conf
cat >"$SLURM_CONF" <<END
ClusterName=here
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$control_port
SlurmdPort=$node_port
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
# Slurm ends jobs that exceed the memory of their rule.
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=1
JobAcctGatherParams=OverMemoryKill
# Finished jobs stay in the list.
MinJobAge=86400
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$cpus RealMemory=$memory State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
# Inside a job the plugin starts srun without variables that begin with SLURM_.
mkdir "$work/bin"
cat >"$work/bin/srun" <<END
#!/bin/sh
SLURM_CONF=$SLURM_CONF exec $(type -P srun) "\$@"
END
chmod 755 "$work/bin/srun"
PATH=$work/bin:$PATH
in_background munged.log munged --foreground --key-file="$work/munge/key" \
    --socket="$work/munge/socket" --seed-file="$work/munge/seed" \
    --pid-file="$work/munge/pid" --log-file="$work/munge/log"
for _ in $(seq 50); do
    [ -S "$work/munge/socket" ] && break
    sleep 0.2
done
in_background slurmctld.log slurmctld -D
in_background slurmd.log slurmd -D
for _ in $(seq 120); do
    state=$(sinfo --noheader --format=%T 2>/dev/null || true)
    [ "$state" = idle ] && break
    sleep 0.5
done
if [ "$state" != idle ]; then
    tail -n 20 "$work"/{munged,slurmctld,slurmd}.log >&2
    refuse "Slurm does not start, see above"
fi

# The sweep with and without Slurm

read -r load _ </proc/loadavg
sweep() { # folder, further options
    local folder=$work/$1 started=$SECONDS
    shift
    mkdir "$folder"
    "$snakemake" --snakefile Snakefile --configfile config/smoke.yaml --directory "$folder" "$@" >&2
    seconds=$((SECONDS - started))
}

# Short intervals, because the plugin's defaults are for shared clusters.
sweep slurm --profile profiles/slurm --latency-wait 5 --slurm-status-command squeue \
    --slurm-init-seconds-before-status-checks 2 --seconds-between-status-checks 2
slurm_seconds=$seconds
jobs=$(squeue --noheader --states=all --sort=i --format="%T|%M|%m|%C|%l|%k")
sweep local --jobs "$cpus"
local_seconds=$seconds

# Results

sums() { # folder: checksums of all results by name
    (cd "$work/$1" && find results -type l -o -name "*.jsonl" | xargs sha256sum | sort)
}
sums slurm >"$work/slurm.sums"
sums local >"$work/local.sums"
count() { grep -c "$1" "$work/local.sums" || true; }
[ "$(count '\.nc$')" -gt 0 ] && [ "$(count /batches/)" -gt 0 ] || refuse "the sweep left no results"
different=$(comm -3 "$work/local.sums" "$work/slurm.sums" | awk '{print $2}' | sort -u)

report() {
    echo "| what | version |"
    echo "| --- | --- |"
    echo "| Slurm | $(slurmctld -V | awk '{print $2}') |"
    echo "| munge | $(munged --version | grep -o '[0-9][0-9.]*' | head -1) |"
    for package in snakemake snakemake-executor-plugin-slurm; do
        echo "| $package | $("$python" -c "import sys; from importlib.metadata import version; \
print(version(sys.argv[1]))" "$package") |"
    done
    echo
    echo "Slurm ran these jobs on one node with $cpus CPUs:"
    echo
    echo "| rule | jobs | completed | CPUs each | memory request | time limit | longest, s |"
    echo "| --- | --- | --- | --- | --- | --- | --- |"
    awk -F'|' '
        {
            rule = $6; sub(/^rule_/, "", rule); sub(/_wildcards_.*/, "", rule)
            if (!(rule in jobs)) order[++rules] = rule
            n = split($2, part, "[:-]"); seconds = part[n] + 60 * part[n - 1] + 3600 * part[n - 2]
            jobs[rule]++; done[rule] += $1 == "COMPLETED"
            memory[rule] = $3; cpus[rule] = $4; limit[rule] = $5
            if (seconds > longest[rule]) longest[rule] = seconds
            all++; completed += $1 == "COMPLETED"
        }
        END {
            for (i = 1; i <= rules; i++) {
                rule = order[i]
                printf "| %s | %d | %d | %s | %s | %s | %d |\n", rule, jobs[rule], done[rule],
                    cpus[rule], memory[rule], limit[rule], longest[rule]
            }
            printf "| all | %d | %d | | | | |\n", all, completed
        }' <<<"$jobs"
    echo
    echo "| run | seconds |"
    echo "| --- | --- |"
    echo "| with Slurm | $slurm_seconds |"
    echo "| snakemake --jobs $cpus | $local_seconds |"
    echo
    echo "The run with Slurm was first. The load average at the start was $load."
    echo
    if [ -z "$different" ]; then
        echo "$(count '\.nc$') datasets and $(count /batches/) batches are equal, byte for byte."
    else
        echo "Not equal:" $different
    fi
}
report | tee ${markdown:+"$markdown"}
[ -z "$different" ]
