#!/usr/bin/env bash
# A Slurm of one node on this machine, without systemd, accounting or keys: for a test only.
#
#     slurm_on_loopback.sh start FOLDER     state, logs and wrappers in FOLDER, all new
#     slurm_on_loopback.sh stop FOLDER      ends what start has started
#
# After the start FOLDER/bin holds srun, sbatch, squeue, scancel, scontrol and sinfo for this Slurm,
# to be put first on PATH: the jobs of Snakemake's executor lose SLURM_CONF on their way.
set -euo pipefail
export PATH=$PATH:/usr/sbin:/sbin

folder=$(mkdir -p "$2" && cd "$2" && pwd)
conf=$folder/slurm.conf

free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

write_configuration() {
    mkdir -p "$folder"/{bin,log,state,spool}
    local user name
    user=$(id -un) name=$(hostname -s)
    cat > "$conf" <<CONF
ClusterName=loopback
SlurmctldHost=$name(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd.log
NodeName=$name NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=16000 State=UNKNOWN
PartitionName=loopback Nodes=$name Default=YES MaxTime=INFINITE State=UP
CONF
    for tool in srun sbatch squeue scancel scontrol sinfo; do
        printf '#!/bin/sh\nSLURM_CONF=%s exec %s "$@"\n' "$conf" "$(command -v $tool)" > "$folder/bin/$tool"
        chmod +x "$folder/bin/$tool"
    done
}

start() {
    write_configuration
    slurmctld -c -f "$conf"
    slurmd -c -f "$conf"
    for _ in $(seq 300); do
        if "$folder/bin/sinfo" --noheader --format %T 2>/dev/null | grep -q '^idle'; then
            return
        fi
        sleep 0.2
    done
    echo "slurm_on_loopback.sh: the node does not come up, see $folder/log" >&2
    tail -n 5 "$folder"/log/* >&2
    stop
    exit 1
}

# By the numbers that the daemons have written, and no others.
stop() {
    "$folder/bin/scancel" --user "$(id -un)" --quiet 2>/dev/null || true
    for daemon in slurmd slurmctld; do
        if [ -f "$folder/$daemon.pid" ]; then
            kill "$(cat "$folder/$daemon.pid")" 2>/dev/null || true
        fi
    done
}

"$1"
