# Figs. 7 and 8 of the paper, and the rounds of Procedure 1. Called with the folder: gnuplot -c plot.gp FOLDER
set terminal pngcairo size 1200,400 font "DejaVu Sans,11" linewidth 1.1
set output ARG1."/procedure_1.png"
set datafile separator comma
map = ARG1."/map.csv"

set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set multiplot layout 1,3 margins 0.075,0.975,0.15,0.88 spacing 0.09,0

set title "Fig. 7: its slope is C3"
set logscale xy
set xlabel "p [V]"
set ylabel "M - C1 [nm/V]" offset 1
set xrange [1:600]
set yrange [0.01:20]
set key bottom right reverse Left samplen 2
plot map using "p":((column("M")-column("C1"))*1e9) with points pt 1 ps 0.6 lc "#0072b2" title "simulated, 1 nm of noise", \
     map using "p":((column("M_fitted")-column("C1"))*1e9) with lines lw 2 lc "#000000" title "fitted"

set title "Fig. 8: its line gives C1 and C2"
unset logscale
set xlabel "p^{C3}"
set ylabel "M = dy/du [nm/V]" offset 1
set xrange [0:*]
set xtics 100
set yrange [0:12]
plot map using "p_to_C3":(column("M")*1e9) with points pt 1 ps 0.6 lc "#0072b2" title "simulated, 1 nm of noise", \
     map using "p_to_C3":(column("M_fitted")*1e9) with lines lw 2 lc "#000000" title "fitted"

set title "Exact points: as printed, C3 runs away"
set logscale x
set xtics autofreq
set xlabel "round of Procedure 1"
set ylabel "C3" offset 1
set xrange [1:1000]
set yrange [0:2]
set key center right
plot 1.7 with lines lw 1.5 dt 3 lc "#000000" title "truth, 1.7", \
     ARG1."/rounds_as_printed.csv" using "round":"C3" with linespoints pt 7 ps 0.5 lw 2 lc "#d55e00" title "as printed", \
     ARG1."/rounds_weighted.csv" using "round":"C3" with lines lw 2.5 lc "#009e73" title "weighted"
unset multiplot
