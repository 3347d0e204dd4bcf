#!/bin/sh
# Trains the bundled policies again: ./train.sh [FOLDER] [PROGRAM]. Each takes about half an hour of one core. The same seed
# gives the same weights on the same machine and version.
set -eu
folder=${1:-runs}
carom=${2:-carom}
for table in match thesis; do
    "$carom" train --reward r3 --table "$table" --seed 1 --steps 5000000 --run "$folder/$table-r3"
    "$carom" train --reward one-cushion --table "$table" --seed 1 --steps 3000000 --run "$folder/$table-one-cushion"
    "$carom" train --reward three-cushion --table "$table" --seed 1 --steps 3000000 --run "$folder/$table-three-cushion"
done
