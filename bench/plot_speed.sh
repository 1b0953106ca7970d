#!/usr/bin/env bash
# Draws the curves that edgepose_speed --csv wrote, of one test set or of several: time over scene points, model points,
# models and threads, and recall over the deadline. What the files do not hold is not drawn; if that is all, exit code 2.
# Usage: bench/plot_speed.sh FOLDER CSV...        the pictures are FOLDER/speed_*.png and FOLDER/recall_over_deadline.png
# Example: bench/plot_speed.sh docs/images range.csv spine.csv
set -euo pipefail
fail() { echo "plot_speed.sh: $*" >&2; exit 2; }
[ $# -ge 2 ] || fail "expected FOLDER CSV..., found $# argument(s)"
folder=$1
shift
[ -d "$folder" ] || fail "$folder: expected a folder, found none"
command -v gnuplot >/dev/null || fail "the program gnuplot is missing; install gnuplot-nox"
header=curve,set,variant,x,median_ms,p99_ms,further_ms,correct_005_percent,correct_010_percent
for csv in "$@"; do
  [ -f "$csv" ] || fail "$csv: expected a file that edgepose_speed --csv wrote, found none"
  [ "$(head -n 1 "$csv")" = "$header" ] || fail "$csv: expected the columns $header, found others"
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

curves=$(tail -q -n +2 "$@" | cut -d, -f1 | sort -u)
grep -qxE 'scene_points|model_points|models|threads|deadline' <<<"$curves" ||
  fail "$*: expected curves, found ${curves:-no line below the columns}; of the parts of edgepose_speed, points, models," \
    "threads and deadline have some"

# lines CURVE COLUMN: the curve's lines as gnuplot data blocks and a plot command. A colour a set; its second variant is
# dashed. What stands at x = none is no point but a level, drawn dotted.
lines() {
  sort -t, -k2,3 -k4,4g "${csvs[@]}" | awk -F, -v curve="$1" -v column="$2" '
    $1 != curve { next }
    {
      key = $2 "," $3
      if (!(key in known)) {
        known[key] = ++count; set_of[count] = $2; variant_of[count] = $3
        if (!($2 in colour)) colour[$2] = ++sets
        dash[count] = ++variants[$2]
      }
      if ($4 == "none") level[known[key]] = $column
      else if ($column != "") data[known[key]] = data[known[key]] $4 " " $column "\n"
    }
    END {
      if (count == 0) exit 3
      for (i = 1; i <= count; ++i) printf "$d%d << END\n%sEND\n", i, data[i]
      printf "plot "
      for (i = 1; i <= count; ++i) {
        name = variant_of[i] == "" ? set_of[i] : set_of[i] ", " variant_of[i]
        printf "%s$d%d using 1:2 with linespoints lw 2 pt 7 ps 0.8 lc %d dt %d title \"%s\"", (i > 1 ? ", " : ""), i,
          colour[set_of[i]], dash[i], name
        if (level[i] != "") printf ", %s with lines lw 1 lc %d dt 3 notitle", level[i], colour[set_of[i]]
      }
      print ""
    }'
}

# draw FILE CURVE COLUMN TITLE X_LABEL Y_LABEL [MORE]: one picture; MORE are further commands of gnuplot.
draw() {
  local script=$work/$1.gp
  local code=0
  lines "$2" "$3" >"$work/lines" || code=$?
  [ "$code" -ne 3 ] || return 0 # nothing of this curve
  [ "$code" -eq 0 ] || fail "awk failed on $2"
  {
    cat <<END
set terminal pngcairo noenhanced size 960,600 font 'Sans,13' background '#ffffff'
set output '$work/$1.png'
set title '$4'
set xlabel '$5'
set ylabel '$6'
set grid lt 1 lw 1 lc rgb '#d8d8d8'
set border 3
set tics nomirror
set key above
set yrange [0:*]
set xrange [0:*]
END
    local i=1 colour
    for colour in 1f6fb4 e08214 2b8a3e b5292a 7a4fa3 17a2b8 d6539b 8a6d3b 7f7f7f a5b800; do
      echo "set linetype $i lc rgb '#$colour'"
      i=$((i + 1))
    done
    printf '%s\n' "${7:-}"
    cat "$work/lines"
  } >"$script"
  gnuplot "$script"
  mv "$work/$1.png" "$folder/$1.png"
  echo "$folder/$1.png"
}

csvs=("$@")
time='median time of an object in an image, ms'
draw speed_scene_points scene_points 5 'Time over scene points: without preprocessing' 'points of the thinned scene' "$time"
draw speed_model_points model_points 5 'Time over model points: without preprocessing' 'points of the model' "$time"
draw speed_models models 5 'Time over models asked for in one image' 'models' 'median time of an image, ms'
draw speed_threads threads 5 'Time over threads' 'threads' "$time" 'set xtics 1
set xrange [0.9:*]'
deadlines='set logscale x
set xrange [5:200]
set xtics (5, 10, 15, 20, 30, 50, 75, 100, 150, 200)'
draw recall_over_deadline deadline 8 'Recall over the deadline (dotted: without one)' 'deadline, ms' \
  'correct at 0.05 d, %' "$deadlines
set yrange [0:105]
set ytics 10"
draw speed_deadline deadline 6 'Real time over the deadline (dotted: without one)' 'deadline, ms' \
  'time of an object in an image, p99, ms' "$deadlines"
