# Seconds of a diagnosis over samples and over candidates. gnuplot -c growth.gp FOLDER PICTURE GOAL
set terminal pngcairo size 1000,420 font "DejaVu Sans,11" linewidth 1.1
set output ARG2
goal = real(ARG3)
what_goal = sprintf("goal: %.0f s", goal)
set datafile separator comma
samples = ARG1."/samples.csv"
candidates = ARG1."/candidates.csv"
# before the axes are logarithmic: stats heeds their ranges
stats samples using (log($1)):(log($2)) every ::1 name "S" nooutput
stats candidates using (log($1)):(log($2)) every ::1 name "C" nooutput

set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set logscale xy
set format x "%'.0f"
set ylabel "time [s]"
set yrange [1:100]
set ytics (1, 2, 5, 10, 20, 50, 100)
set key top left samplen 2
set multiplot layout 1,2 margins 0.075,0.985,0.15,0.88 spacing 0.1,0

set title "All effects, by the length of the record"
set xlabel "samples"
set xrange [4000:50000]
set xtics (5000, 10000, 20000, 40000)
plot goal with lines dt 2 lw 1 lc "#666666" title what_goal, \
     exp(S_slope * log(x) + S_intercept) with lines lw 1 lc "#56b4e9" title sprintf("samples^{%.2f}", S_slope), \
     samples using 1:2 every ::1 with points pt 7 lc "#0072b2" title "measured"

set title "10,000 samples, by the candidates tried"
set xlabel "candidates"
set xrange [9:1100]
set xtics (10, 30, 100, 300, 1000)
plot goal with lines dt 2 lw 1 lc "#666666" title what_goal, \
     exp(C_slope * log(x) + C_intercept) with lines lw 1 lc "#56b4e9" title sprintf("candidates^{%.2f}", C_slope), \
     candidates using 1:2 every ::1 with points pt 7 lc "#0072b2" title "measured"
