#!/bin/sh
# A sweep as a Slurm array job: eight tasks of one core, each with its part of the runs.
#
#     sbatch sweep_slurm.sh                          # again after a failure: finished runs are kept
#     python sweep_slurm.py gather sweep-results     # once the job has ended
#
#SBATCH --job-name=sweep
#SBATCH --array=0-7
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --mem=2G
#SBATCH --time=00:30:00

exec python sweep_slurm.py run sweep-results "$@"
