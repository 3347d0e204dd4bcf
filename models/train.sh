#!/bin/sh
# Trains policies like the bundled ones. Use: models/train.sh [FOLDER] [PROGRAM]. A second start resumes where the first stopped. The same seed
# gives the same weights on the same machine with the same version.
#
# The bundled weights come from stages of older versions. The first stages for match started from networks older than this file, and did not
# require room for the cue. In the stages up to match-r3-third, match-one-cushion-second and match-three-cushion-second, balls stayed on the
# cloth. Some stages were stopped by hand, as the comments below state; here they run to their planned end, and their learning rates decay to
# zero over that longer run. The original stages took thirty-eight hours of a shared core in total; complete stages take longer.
set -eu
folder=${1:-runs}
carom=${2:-carom}

train() {
    name=$1
    shift
    "$carom" train --continue --run "$folder/$name" --evaluate-every 384000 "$@"
}

train textbook-r3-first --table textbook --reward r3 --seed 1 --steps 5000000
# Second stages explore closer to the critic's favourite: the critic's choice caused most of the loss.
near_favourite="exploration={ noise = [0.01, 0.03, 0.1], uniform = 0.05 }"
train textbook-r3 --from "$folder/textbook-r3-first" --seed 2 --steps 3000000 --set critic_chooses=0.6 --set "$near_favourite"
train textbook-one-cushion --table textbook --reward one-cushion --seed 1 --steps 2500000
# match starts from the weights for textbook, except at three cushions, where the actor chooses all five cue inputs.
train match-r3-first --from "$folder/textbook-r3" --table match --seed 11 --steps 1500000
train match-r3-second --from "$folder/match-r3-first" --seed 21 --steps 3000000
train match-r3-third --from "$folder/match-r3-second" --seed 31 --steps 5000000
train match-r3-fourth --from "$folder/match-r3-third" --seed 41 --steps 2500000
train match-r3-fifth --from "$folder/match-r3-fourth" --seed 51 --steps 3000000
train match-one-cushion-first --from "$folder/textbook-one-cushion" --table match --seed 12 --steps 1500000
train match-one-cushion-second --from "$folder/match-one-cushion-first" --seed 22 --steps 3000000
train match-one-cushion-third --from "$folder/match-one-cushion-second" --seed 42 --steps 2000000
train match-one-cushion-fourth --from "$folder/match-one-cushion-third" --seed 52 --steps 3000000
train match-three-cushion-first --table match --reward three-cushion --seed 1 --steps 8000000
train match-three-cushion-second --from "$folder/match-three-cushion-first" --seed 2 --steps 6000000 --set critic_chooses=0.6 --set "$near_favourite"
train match-three-cushion-third --from "$folder/match-three-cushion-second" --seed 43 --steps 4000000
train match-three-cushion-fourth --from "$folder/match-three-cushion-third" --seed 53 --steps 7000000
train match-three-cushion-fifth --from "$folder/match-three-cushion-fourth" --seed 63 --steps 12000000
train thesis-r3-first --table thesis --reward r3 --seed 3 --steps 4000000 --set "critic_layers=[256, 256, 256]"
train thesis-one-cushion --table thesis --reward one-cushion --seed 1 --steps 3000000
train thesis-three-cushion-first --table thesis --reward three-cushion --seed 1 --steps 2500000
# Last stages, except for two files for thesis: some of the shots are the networks' own best proposals, and a penalty keeps the outputs from
# the flat part of the hyperbolic tangent. The learning rates begin lower each time. Two of the runs were stopped by hand, after 6,628,992 and
# 11,251,584 shots.
match="--set ranking=0.4 --set saturation_penalty=0.1"
thesis="--set ranking=0.3 --set saturation_penalty=0.1"
lower="--set critic_learning_rate=0.0011 --set actor_learning_rate=0.0003"
lowest="--set critic_learning_rate=0.0008 --set actor_learning_rate=0.00025"
train match-r3-sixth --from "$folder/match-r3-fifth" --seed 61 --steps 6000000 $match
train match-r3-seventh --from "$folder/match-r3-sixth" --seed 63 --steps 5000000 $lower
train match-r3-eighth --from "$folder/match-r3-seventh" --seed 65 --steps 5000000 $lowest
train match-r3 --from "$folder/match-r3-eighth" --seed 67 --steps 8000000 $lowest
train match-one-cushion-fifth --from "$folder/match-one-cushion-fourth" --seed 62 --steps 6000000 $match
train match-one-cushion --from "$folder/match-one-cushion-fifth" --seed 64 --steps 3500000 $lower
train match-three-cushion-sixth --from "$folder/match-three-cushion-fifth" --seed 93 --steps 16000000 $match
train match-three-cushion-seventh --from "$folder/match-three-cushion-sixth" --seed 95 --steps 5000000 $lower
train match-three-cushion-eighth --from "$folder/match-three-cushion-seventh" --seed 97 --steps 4000000 $lowest
train match-three-cushion-ninth --from "$folder/match-three-cushion-eighth" --seed 99 --steps 4000000 $lowest
train thesis-r3 --from "$folder/thesis-r3-first" --seed 5 --steps 3000000 $lowest
train thesis-three-cushion-second --from "$folder/thesis-three-cushion-first" --seed 92 --steps 30000000 $thesis
train thesis-three-cushion-third --from "$folder/thesis-three-cushion-second" --seed 94 --steps 5500000 $lower
train thesis-three-cushion-fourth --from "$folder/thesis-three-cushion-third" --seed 96 --steps 4000000 $lowest
# Networks that take the table's constants and the player's errors as inputs. They start from the critics above, with new actors.
context() {
    name=$1
    shift
    train "$name" --set context=true --set ranking=0.6 --set critic_chooses=0.15 --set saturation_penalty=0.1 --set attempts=8 --set new_actor=true "$@"
}
wide="exploration={ noise = [0.015, 0.05, 0.2], uniform = 0.05 }"
rate="--set critic_learning_rate=0.0012"
# Stopped by hand after 1,239,360 shots.
context context-three-cushion-first --from "$folder/match-three-cushion-fifth" --seed 72 --steps 3500000 --set "$wide"
context context-three-cushion-second --from "$folder/context-three-cushion-first" --seed 81 --steps 17000000 $rate
context context-r3-first --from "$folder/match-r3-fifth" --seed 82 --steps 8000000 $rate
# Stopped by hand after 4,570,176 shots.
context context-one-cushion-first --from "$folder/match-one-cushion-fourth" --seed 83 --steps 5500000 $rate
# Three cushions without errors on every table like match: the networks that learned match alone now learn the other tables.
perfect() {
    name=$1
    shift
    train "$name" --set context=true --set perfect=1.0 --set saturation_penalty=0.1 "$@"
}
fast="--set critic_learning_rate=0.0012 --set actor_learning_rate=0.0004"
perfect match-three-cushion-tenth --from "$folder/match-three-cushion-ninth" --seed 501 --steps 12000000 $fast --set ranking=0.4
perfect match-three-cushion-eleventh --from "$folder/match-three-cushion-tenth" --seed 502 --steps 40000000 $fast --set ranking=0.6
slower="--set critic_learning_rate=0.001 --set actor_learning_rate=0.0003 --set ranking=0.6"
perfect match-three-cushion-twelfth --from "$folder/match-three-cushion-eleventh" --seed 503 --steps 24000000 $slower
perfect match-three-cushion-thirteenth --from "$folder/match-three-cushion-twelfth" --seed 504 --steps 16000000 $slower
# Then only the critic learns.
critic_only="--set ranking=0.7 --set actor_learning_rate=0.000000001 --set actor_batch_size=1"
perfect match-three-cushion-fourteenth --from "$folder/match-three-cushion-thirteenth" --seed 505 --steps 14000000 $critic_only --set critic_learning_rate=0.0013
perfect match-three-cushion --from "$folder/match-three-cushion-fourteenth" --seed 506 --steps 6000000 $critic_only --set critic_learning_rate=0.0003
# With paths to the first ball by a cushion. In these stages, bounces too small to see do not count as cushions.
rails="--set rails_first=true"
strong="--set critic_learning_rate=0.0013 --set actor_learning_rate=0.0005"
train thesis-three-cushion-fifth --from "$folder/thesis-three-cushion-fourth" --seed 783 --steps 12000000 $match $strong $rails
train thesis-three-cushion --from "$folder/thesis-three-cushion-fifth" --seed 785 --steps 10000000 --set critic_learning_rate=0.0011 --set actor_learning_rate=0.0004
# First heads with separate speed ranges. Then expert iteration: a search finds the strokes that players with errors make most often. Then stages
# without a search, in which the critic learns to choose; at three cushions only the critic learns, because there the actor went back to harder
# strokes. Up to the 26th stage at three cushions, the searches compared 96 strokes of their own and the proposals, as in versions before
# 2026-11-26.
heads="$rate --set heads=9 --set actor_batch_size=64"
expert_iteration="--set ranking=0.4 --set searched=2 --set imitation=0.3"
# The same with an actor that does not learn: its learning rate of 1e-9 was inherited with the weights, which was noticed only after the 22nd
# stage at three cushions. In those stages the searches trained only the critic. They were run with imitation, which has no effect on such an
# actor and is refused today.
frozen_actor="--set ranking=0.4 --set searched=2 --set imitation=0"
choice="--set new_actor=false --set searched=0 --set imitation=0"
critic="--set ranking=0.7 --set critic_learning_rate=0.0013 --set actor_learning_rate=0.000000001 --set actor_batch_size=1"
both="--set ranking=0.6 --set critic_learning_rate=0.0011 --set actor_learning_rate=0.0003"
# Stopped by hand after 6,573,888 shots.
context context-three-cushion-third --from "$folder/context-three-cushion-second" --seed 101 --steps 12000000 $heads --set ranking=0.5 \
    --set "head_speeds=[[1.2, 2.6], [2.2, 4.0], [3.5, 6.0]]"
context context-r3-second --from "$folder/context-r3-first" --seed 102 --steps 7000000 $heads --set ranking=0.5 \
    --set "head_speeds=[[0.3, 2.0], [1.4, 3.6], [2.8, 6.0]]"
# The first 1.7 and 1.8 million shots of the next two stages were played with a version that stored a search's strokes with the attempts that had
# selected them. The first stage was stopped by hand after 3,395,904 shots.
speeds="head_speeds=[[0.8, 2.6], [1.8, 4.2], [3.0, 6.0]]"
context context-three-cushion-fourth --from "$folder/context-three-cushion-third" --seed 111 --steps 8000000 $heads $expert_iteration --set "$speeds"
context context-three-cushion-fifth --from "$folder/context-three-cushion-fourth" --seed 141 --steps 4200000 $heads $choice $critic --set "$speeds"
speeds="head_speeds=[[0.5, 2.0], [1.4, 3.6], [2.8, 6.0]]"
context context-r3-third --from "$folder/context-r3-second" --seed 112 --steps 3400000 $heads $expert_iteration --set "$speeds"
context context-r3-fourth --from "$folder/context-r3-third" --seed 132 --steps 3900000 $heads $choice $both --set "$speeds"
context context-one-cushion-second --from "$folder/context-one-cushion-first" --seed 202 --steps 6000000 $heads $expert_iteration --set "$speeds"
context context-one-cushion-third --from "$folder/context-one-cushion-second" --seed 232 --steps 3900000 $heads $choice $both --set "$speeds"
# The same once more. `context` sets new_actor=true; this later setting overrides it.
keep_actor="--set new_actor=false"
context context-r3-fifth --from "$folder/context-r3-fourth" --seed 212 --steps 5000000 $heads $expert_iteration $keep_actor --set "$speeds"
context context-r3-sixth --from "$folder/context-r3-fifth" --seed 242 --steps 3900000 $heads $choice $both --set "$speeds"
context context-one-cushion-fourth --from "$folder/context-one-cushion-third" --seed 212 --steps 4000000 $heads $expert_iteration $keep_actor --set "$speeds"
context context-one-cushion-fifth --from "$folder/context-one-cushion-fourth" --seed 242 --steps 3500000 $heads $choice $both --set "$speeds"
speeds="head_speeds=[[0.8, 2.6], [1.8, 4.2], [3.0, 6.0]]"
context context-three-cushion-sixth --from "$folder/context-three-cushion-fifth" --seed 211 --steps 6000000 $heads $frozen_actor $keep_actor --set "$speeds"
context context-three-cushion-seventh --from "$folder/context-three-cushion-sixth" --seed 241 --steps 4200000 $heads $choice $critic --set "$speeds"
# More of both at three cushions, where the choice caused most of the loss. In the last stages only the critic learns, at a quarter of its
# learning rate.
fine="--set ranking=0.7 --set critic_learning_rate=0.0003 --set actor_learning_rate=0.000000001 --set actor_batch_size=1"
context context-three-cushion-eighth --from "$folder/context-three-cushion-seventh" --seed 311 --steps 5000000 $heads $frozen_actor $keep_actor --set "$speeds"
context context-three-cushion-ninth --from "$folder/context-three-cushion-eighth" --seed 321 --steps 6000000 $heads $frozen_actor $keep_actor --set "$speeds"
context context-three-cushion-tenth --from "$folder/context-three-cushion-ninth" --seed 351 --steps 5000000 $heads $choice $critic --set "$speeds"
context context-three-cushion-eleventh --from "$folder/context-three-cushion-tenth" --seed 361 --steps 14000000 $heads $choice $critic --set "$speeds"
context context-three-cushion-twelfth --from "$folder/context-three-cushion-eleventh" --seed 371 --steps 6000000 $heads $choice $fine --set "$speeds"
context context-three-cushion-thirteenth --from "$folder/context-three-cushion-twelfth" --seed 331 --steps 5000000 $heads $frozen_actor $keep_actor --set "$speeds"
context context-three-cushion-fourteenth --from "$folder/context-three-cushion-thirteenth" --seed 381 --steps 6000000 $heads $choice $critic --set "$speeds"
context context-three-cushion-fifteenth --from "$folder/context-three-cushion-fourteenth" --seed 391 --steps 6000000 $heads $choice $fine --set "$speeds"
# With paths to the first ball by a cushion. The sixteenth stage was played with a version that considered all four cushions, and stopped by hand
# after 760,320 shots.
context context-three-cushion-sixteenth --from "$folder/context-three-cushion-fifteenth" --seed 601 --steps 3600000 $heads $frozen_actor $keep_actor --set "$speeds" $rails
context context-three-cushion-seventeenth --from "$folder/context-three-cushion-sixteenth" --seed 611 --steps 3200000 $heads $frozen_actor $keep_actor --set "$speeds" $rails
context context-three-cushion-eighteenth --from "$folder/context-three-cushion-seventeenth" --seed 621 --steps 9000000 $heads $choice $critic --set "$speeds" $rails
context context-three-cushion-nineteenth --from "$folder/context-three-cushion-eighteenth" --seed 631 --steps 2500000 $heads $choice $fine --set "$speeds" $rails
context context-three-cushion-twentieth --from "$folder/context-three-cushion-nineteenth" --seed 641 --steps 6000000 $heads $frozen_actor $keep_actor --set "$speeds" $rails
context context-three-cushion-21st --from "$folder/context-three-cushion-twentieth" --seed 651 --steps 8000000 $heads $choice $critic --set "$speeds" $rails
context context-three-cushion-22nd --from "$folder/context-three-cushion-21st" --seed 661 --steps 2500000 $heads $choice $fine --set "$speeds" $rails
# The first stage at three cushions since the fourth in which the actor learns.
learning_actor="--set actor_learning_rate=0.0005"
context context-three-cushion-23rd --from "$folder/context-three-cushion-22nd" --seed 671 --steps 2300000 $heads $expert_iteration $learning_actor $keep_actor --set "$speeds" $rails
context context-three-cushion-24th --from "$folder/context-three-cushion-23rd" --seed 681 --steps 5000000 $heads $choice $critic --set "$speeds" $rails
context context-three-cushion-25th --from "$folder/context-three-cushion-24th" --seed 691 --steps 2000000 $heads $choice $fine --set "$speeds" $rails
# Stopped by hand after 4,023,936 shots.
context context-three-cushion-26th --from "$folder/context-three-cushion-25th" --seed 701 --steps 14000000 $heads $expert_iteration $learning_actor $keep_actor --set "$speeds" $rails
# From here on the searches try 2,048 strokes and compare those that score without errors and that the critic rates highest. In the first 450,000
# shots of the 27th stage, neighbours that the critic had overrated were not stored yet. The 30th stage was stopped by hand after 1,340,544 shots.
guided_iteration="--set ranking=0.4 --set searched=4 --set imitation=0.6"
context context-three-cushion-27th --from "$folder/context-three-cushion-26th" --seed 711 --steps 3800000 $heads $guided_iteration $learning_actor $keep_actor --set "$speeds" $rails
context context-three-cushion-28th --from "$folder/context-three-cushion-27th" --seed 721 --steps 6000000 $heads $choice $critic --set "$speeds" $rails
context context-three-cushion-29th --from "$folder/context-three-cushion-28th" --seed 731 --steps 2500000 $heads $choice $fine --set "$speeds" $rails
context context-three-cushion-30th --from "$folder/context-three-cushion-29th" --seed 741 --steps 3800000 $heads $guided_iteration $learning_actor $keep_actor --set "$speeds" $rails
# Labels are the mean of four times as many attempts for every shot.
context context-three-cushion-31st --from "$folder/context-three-cushion-30th" --seed 751 --steps 8000000 $heads $choice $critic --set attempts=32 --set shots_per_update=96 --set "$speeds" $rails
speeds="head_speeds=[[0.5, 2.0], [1.4, 3.6], [2.8, 6.0]]"
context context-one-cushion-sixth --from "$folder/context-one-cushion-fifth" --seed 411 --steps 6000000 $heads $choice $fine --set "$speeds"
context context-r3-seventh --from "$folder/context-r3-sixth" --seed 411 --steps 6000000 $heads $choice $fine --set "$speeds"
# One more update: the critics' probabilities for their own choice are calibrated at the end of a run, and the earlier stages are older than
# that calibration.
train context-three-cushion --from "$folder/context-three-cushion-31st" --reward three-cushion --seed 772 --steps 192 --set calibrated=32768
train context-one-cushion-seventh --from "$folder/context-one-cushion-sixth" --reward one-cushion --seed 772 --steps 192 --set calibrated=32768
train context-r3-calibrated --from "$folder/context-r3-seventh" --reward r3 --seed 772 --steps 192 --set calibrated=32768
# One cushion and straight rail with paths to the first ball by a cushion.
speeds="head_speeds=[[0.5, 2.0], [1.4, 3.6], [2.8, 6.0]]"
context context-one-cushion-eighth --from "$folder/context-one-cushion-seventh" --seed 787 --steps 2400000 $guided_iteration $keep_actor $rails \
    --set critic_learning_rate=0.0012 --set actor_learning_rate=0.0005 --set actor_batch_size=64 --set heads=9 --set "$speeds"
train context-one-cushion --from "$folder/context-one-cushion-eighth" --seed 788 --steps 4500000 --set searched=0 --set imitation=0 $critic --set calibrated=32768
context context-r3-eighth --from "$folder/context-r3-calibrated" --seed 791 --steps 2400000 $guided_iteration $keep_actor $rails \
    --set critic_learning_rate=0.0012 --set actor_learning_rate=0.0005 --set actor_batch_size=64 --set heads=9 --set "$speeds"
train context-r3 --from "$folder/context-r3-eighth" --seed 792 --steps 4500000 --set searched=0 --set imitation=0 $critic --set calibrated=32768
