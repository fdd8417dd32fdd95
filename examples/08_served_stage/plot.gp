# The stage under its feedforward, and what the diagnosis leaves of the record. Called with the folder of the records:
# gnuplot -c plot.gp FOLDER
set terminal pngcairo size 1200,420 font "DejaVu Sans,11" linewidth 1.1
set output ARG1."/08_served_stage.png"
set datafile separator comma
record = ARG1."/record.csv"
traces = ARG1."/diagnosis/traces.csv"

set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set multiplot layout 1,3 margins 0.05,0.985,0.15,0.88 spacing 0.07,0

set title "The stage"
set xlabel "voltage [V]"
set ylabel "displacement [um]" offset 1
plot record using 3:2 with lines lw 1 lc "#0072b2" notitle

set title "Tracking error"
set xlabel "t [s]"
set ylabel "Y - REF [um]" offset 1
plot record using 1:5 with lines lw 1 lc "#d55e00" notitle

set title "What the models leave"
set ylabel "model - measured [um]" offset 1
set key top right samplen 2
set yrange [-0.9:1.4]
plot traces using 1:($4 - $2) with lines lw 1 lc "#bbbbbb" title "tuned", \
     traces using 1:($5 - $2) with lines lw 1 lc "#0072b2" title "with the effects that are named"
unset multiplot
