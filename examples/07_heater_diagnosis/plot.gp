# Wide loops without hysteresis, and what the rounds leave. Called with the folder of the table:
# gnuplot -c plot.gp FOLDER
set terminal pngcairo size 1200,420 font "DejaVu Sans,11" linewidth 1.1
set output ARG1."/07_heater_diagnosis.png"
set datafile separator comma
table = ARG1."/heaters.csv"

set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set multiplot layout 1,3 margins 0.06,0.985,0.15,0.88 spacing 0.075,0

set title "A lag draws a wide loop"
set xlabel "power [%]"
set ylabel "temperature [degC]" offset 1
set xrange [18:42]
set key top left reverse Left samplen 2
plot table using "u1":"y1" with lines lw 1.2 lc "#d55e00" title "heater 1", \
     table using "u2":"y2" with lines lw 1.2 lc "#0072b2" title "heater 2"

set xlabel "t [s]"
set ylabel "model - measured [degC]" offset 1
set xrange [400:7200]
set yrange [-4:5]
set xtics 2000
set key top right noreverse Right
set title "Heater 1"
plot table using "t":"before1" with lines lw 1.2 lc "#bbbbbb" title "tuned", \
     table using "t":"after1" with lines lw 1.2 lc "#d55e00" title "after the last round"
set title "Heater 2"
plot table using "t":"before2" with lines lw 1.2 lc "#bbbbbb" title "tuned", \
     table using "t":"after2" with lines lw 1.2 lc "#0072b2" title "after the last round"
unset multiplot
