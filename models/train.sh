#!/bin/sh
# Trains the bundled policies again: models/train.sh [FOLDER] [PROGRAM]. The same seed gives the same weights on the same machine
# with the same version. All of it takes about four hours of a shared core.
set -eu
folder=${1:-runs}
carom=${2:-carom}

train() {
    name=$1
    shift
    "$carom" train --run "$folder/$name" --evaluate-every 384000 "$@"
}

train match-r3-first --table match --reward r3 --seed 1 --steps 5000000
# A second round nearer to what it has learnt: the critic's choice was what lost most.
train match-r3 --from "$folder/match-r3-first" --seed 2 --steps 3000000 --set critic_chooses=0.6 \
    --set "exploration={ noise = [0.01, 0.03, 0.1], uniform = 0.05 }"
train match-one-cushion --table match --reward one-cushion --seed 1 --steps 2500000
train match-three-cushion --table match --reward three-cushion --seed 1 --steps 8000000 --set actions=phi-v
train thesis-r3 --table thesis --reward r3 --seed 1 --steps 4000000
train thesis-one-cushion --table thesis --reward one-cushion --seed 1 --steps 3000000
train thesis-three-cushion --table thesis --reward three-cushion --seed 1 --steps 2500000
