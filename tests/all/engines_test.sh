#!/usr/bin/env bash
# The commands of tiles and studies on real engines: a Slurm of one node, which the test configures,
# starts and ends, and Snakemake with the Snakefile of docs/examples.
. "$(dirname "$0")/../lib.sh"

# write_slurm_conf PORT: configures a cluster of this machine only, with all its files in this
# folder.
write_slurm_conf() {
    local host
    host=$(hostname -s)
    mkdir -p state spool
    cat >slurm.conf <<END
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$1
SlurmdPort=$(($1 + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$PWD/munge.socket
CredType=cred/munge
StateSaveLocation=$PWD/state
SlurmdSpoolDir=$PWD/spool
SlurmctldPidFile=$PWD/slurmctld.pid
SlurmdPidFile=$PWD/slurmd.pid
SlurmctldLogFile=$PWD/slurmctld.log
SlurmdLogFile=$PWD/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
MpiDefault=none
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP
END
}

# Ends the processes that start_slurm started, by their process ids.
stop_slurm() {
    # shellcheck disable=SC2086
    kill $DAEMONS 2>/dev/null
    # shellcheck disable=SC2086
    wait $DAEMONS 2>/dev/null
}

# Starts munge, the controller and the node in this folder, as child processes of the test.
start_slurm() {
    local port=$((20000 + $$ % 20000)) i
    for program in munged slurmctld slurmd sbatch; do
        PATH=$PATH:/usr/sbin command -v $program >/dev/null || skip "Slurm cannot run: $program is not installed"
    done
    [ "$(id -u)" -eq 0 ] || skip "Slurm cannot run: its daemons want to be root"
    write_slurm_conf $port
    export SLURM_CONF=$PWD/slurm.conf
    head -c 1024 /dev/urandom >munge.key
    chmod 400 munge.key
    DAEMONS=
    trap stop_slurm EXIT
    /usr/sbin/munged --foreground --force --key-file "$PWD/munge.key" --socket "$PWD/munge.socket" \
        --pid-file "$PWD/munge.pid" --log-file "$PWD/munge.log" --seed-file "$PWD/munge.seed" >munged.log 2>&1 &
    DAEMONS=$!
    for ((i = 0; i < 50; i++)); do
        [ -S munge.socket ] && break
        sleep 0.1
    done
    /usr/sbin/slurmctld -D -i >ctld.log 2>&1 &
    DAEMONS="$! $DAEMONS"
    /usr/sbin/slurmd -D -N "$(hostname -s)" >d.log 2>&1 &
    DAEMONS="$! $DAEMONS"
    for ((i = 0; i < 200; i++)); do
        [ "$(sinfo -h -o %T 2>/dev/null)" = idle ] && return
        sleep 0.1
    done
    skip "Slurm cannot run here: $(cat ctld.log d.log slurmctld.log slurmd.log 2>/dev/null | grep -iE 'error|fatal' | tail -2 | tr '\n' ' ')"
}

# submit PLAN LINES: runs the given lines of the plan as an array of jobs, and waits for them.
submit() {
    # shellcheck disable=SC2016
    sbatch --quiet --wait --chdir="$PWD" --output=job-%a.log --array="$2" \
        --wrap 'sed -n "${SLURM_ARRAY_TASK_ID}p" '"$1"' | sh' >sbatch.log 2>&1
}

# Slow: daemons that start, and jobs that wait for their scheduler.
test_slurm_draws_tiles_and_grows_a_study_after_a_job_was_killed() {
    start_slurm
    run_ok corcast grow --terminals 60 --seed 7 --quiet -o tree.swc
    mkdir tiles
    run_ok corcast render tree.swc --size 103x171 --quiet -o whole.png
    run_ok corcast render tree.swc --size 103x171 --quiet -o tiles/p.png --tiles 4 --commands
    cp stdout plan.txt
    sed '2s/^\(.*\) && \(.*\)$/if [ -e tried ]; then \1 \&\& \2; else touch tried; \1; exec \2 \& kill -9 $!; wait $!; fi/' \
        plan.txt >killed.txt
    ! submit killed.txt 1-4 || fail "expected a failed job"
    run corcast merge tiles -o merged.png
    expect_sentence 'tile 2 of 4 is missing; there are 3'
    submit killed.txt 1-4 || fail "expected all jobs to end well: $(cat job-*.log)"
    run_ok corcast merge tiles -o merged.png
    expect_same whole.png merged.png
    printf '[grow]\nterminals = 40\nseed = 1..3\n' >plan.ini
    run_ok corcast study plan.ini -o here --quiet
    run_ok corcast study plan.ini -o there --quiet --commands
    cp stdout study.txt
    submit study.txt 1-3 || fail "expected all jobs to end well: $(cat job-*.log)"
    run_ok corcast merge there -o study.csv
    expect_same here/study.csv study.csv
}

# Slow: Snakemake starts.
test_snakemake_makes_the_table_of_the_example() {
    command -v snakemake >/dev/null || skip "Snakemake is not installed"
    sed 's/range(1, 11)/range(1, 4)/' "$REPO/docs/examples/study/Snakefile" >Snakefile
    export PATH=$PWD/bin:$PATH XDG_CACHE_HOME=$PWD/cache
    mkdir bin
    ln -s "$CORCAST" bin/corcast
    snakemake --quiet --cores 2 >log 2>&1 || fail "expected Snakemake to make the table: $(tail -5 log)"
    [ "$(wc -l <study.csv)" -eq 7 ] || fail "expected 6 rows, got: $(cat study.csv)"
    printf '[grow]\nseed = 1..3\ngamma = 2.5, 3\n' >plan.ini
    run_ok corcast study plan.ini -o runs --quiet
    jq -r '[.segments, .total_length_mm, .target] | @csv' runs/study.jsonl >ours
    for name in {1..3}-{2.5,3}; do jq -r '[.segments, .total_length_mm, .target] | @csv' "info/$name.json"; done >theirs
    expect_same ours theirs
    snakemake --quiet --cores 2 >log 2>&1
    cp study.csv before.csv
    rm trees/2-3.swc info/2-3.json
    snakemake --quiet --cores 2 >log 2>&1 || fail "expected Snakemake to make what is missing: $(tail -5 log)"
    expect_same before.csv study.csv
}

run_tests
