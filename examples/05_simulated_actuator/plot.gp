# The simulated machine. Called with the folder of its records: gnuplot -c plot.gp FOLDER
set terminal pngcairo size 1200,400 font "DejaVu Sans,11" linewidth 1.1
set output ARG1."/simulated_actuator.png"
set datafile separator comma
identify = ARG1."/simulated_identify.csv"
test = ARG1."/simulated_test.csv"

set key off
set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set multiplot layout 1,3 margins 0.06,0.975,0.15,0.88 spacing 0.085,0

set title "Simulated: 40 periods of identification"
set xlabel "u [V]"
set ylabel "y [µm]" offset 1
set xrange [-0.2:3.8]
set yrange [*:*]
plot identify using "u":"y" with lines lw 1.2 lc "#0072b2"

set title "Simulated: a falling amplitude"
plot test using "u":($1 >= 10 && $1 < 15 ? column("y") : NaN) with lines lw 1.5 lc "#d55e00"

set title "Simulated: creep, by log t"
set logscale x
set xlabel "t [s]"
set ylabel "mean of a period [µm]" offset 1
set xrange [1:50]
set xtics (1, 2, 5, 10, 20, 50)
plot ARG1."/simulated_creep.csv" using "t":"mean" with points pt 7 ps 0.6 lc "#009e73"
unset multiplot
