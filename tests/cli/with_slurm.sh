#!/bin/bash
# Usage: with_slurm.sh FOLDER COMMAND [ARGUMENTS...]
#
# Starts a Slurm cluster of this one machine, with all its files in FOLDER, runs the command, waits
# until all jobs that it submitted have ended, and stops the cluster. Needs to be root, as slurmd
# does. Ends as the command did; 77 where Slurm cannot be started here, with a reason.
set -u
folder=$(realpath "$1")
shift

cannot() {
  echo "Slurm cannot be started here: $*" >&2
  exit 77
}

for program in slurmctld slurmd sbatch squeue munged; do
  PATH=$PATH:/usr/sbin command -v $program >/dev/null || cannot "there is no $program"
done
[ "$(id -u)" = 0 ] || cannot "slurmd has to be root"
PATH=$PATH:/usr/sbin

mkdir -p "$folder/munge" "$folder/state" "$folder/spool"
chmod 755 "$folder" "$folder/munge" # munged asks for that
# munged wants its folders, all the way up, not to be writable for others: /tmp is, with the sticky bit.
dd if=/dev/urandom of="$folder/munge/key" bs=1024 count=1 status=none
chmod 400 "$folder/munge/key"
munged --force --foreground --key-file "$folder/munge/key" --socket "$folder/munge/socket" \
  --pid-file "$folder/munge/pid" --log-file "$folder/munge/log" --seed-file "$folder/munge/seed" &
munge=$!

port=$((20000 + $$ % 20000))
host=$(hostname -s)
cat >"$folder/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
MpiDefault=none
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=0
MinJobAge=300
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP OverSubscribe=FORCE:4
CONF
export SLURM_CONF=$folder/slurm.conf
slurmctld -D &
controller=$!
slurmd -D -N "$host" &
daemon=$!
# shellcheck disable=SC2317 # it is called by the trap
stop() {
  kill -9 "$daemon" "$controller" "$munge"
  wait "$daemon" "$controller" "$munge"
} 2>/dev/null
trap stop EXIT

for _ in $(seq 100); do
  [ "$(sinfo -h -o %t 2>/dev/null)" = idle ] && break
  sleep 0.2
done
[ "$(sinfo -h -o %t 2>/dev/null)" = idle ] || cannot "$(tail -n 3 "$folder/slurmctld.log" "$folder/slurmd.log")"

"$@"
status=$?
while [ -n "$(squeue -h)" ]; do sleep 0.3; done
exit $status
