# How the gap shrinks with each named effect, and what is left. Called with the folder of the tables:
# gnuplot -c plot.gp FOLDER
set terminal pngcairo size 1200,420 font "DejaVu Sans,11" linewidth 1.1
set output ARG1."/06_piezo_diagnosis.png"
set datafile separator comma
rounds = ARG1."/rounds.csv"
loop = ARG1."/last_cycle.csv"
means = ARG1."/means.csv"
stats rounds using 1 nooutput
last = int(STATS_max)
array colour[5] = ["#bbbbbb", "#0072b2", "#d55e00", "#009e73", "#cc79a7"]

set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set multiplot layout 1,3 margins 0.06,0.985,0.15,0.88 spacing 0.075,0

set title "How far the gap shrinks"
set xlabel "named effects"
set ylabel "RMSE over range [%]" offset 1
set xrange [-0.3:last+0.3]
set yrange [0:1.6]
set xtics 1
set key top right samplen 2
plot rounds using "effects":"fitted" with linespoints pt 7 lw 1.5 lc "#0072b2" title "cycles 2 to 21", \
     rounds using "effects":"held_out" with linespoints pt 7 lw 1.5 lc "#d55e00" title "held-out cycles", \
     0.76 with lines dt 2 lw 1 lc "#666666" title "12 plays and a cubic"

set title "What is left of the last cycle"
set xlabel "u [V]"
set ylabel "model - measured [um]" offset 1
set xrange [0:3.7]
set yrange [-1.4:2]
plot for [i=0:last] loop using "u":(column(sprintf("after%d", i))) with lines lw 1.5 lc rgb colour[i+1] title sprintf("%d effects", i)

set title "What is left of its mean"
set xlabel "t [s]"
set ylabel "mean over a cycle [um]" offset 1
set xrange [0:41]
set yrange [-0.3:0.45]
set xtics autofreq
plot for [i=0:last] means using "t":(column(sprintf("after%d", i))) with lines lw 1.5 lc rgb colour[i+1] title sprintf("%d effects", i)
unset multiplot
