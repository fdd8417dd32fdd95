# The loop of a real stack, what the models leave, and the tracking error. Called with the folder of the tables:
# gnuplot -c plot.gp FOLDER
set terminal pngcairo size 1200,420 font "DejaVu Sans,11" linewidth 1.1
set output ARG1."/04_piezo_stack.png"
set datafile separator comma
loop = ARG1."/loop.csv"
tracking = ARG1."/tracking.csv"

set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set multiplot layout 1,3 margins 0.055,0.985,0.15,0.88 spacing 0.07,0

set title "A held-out cycle"
set xlabel "u [V]"
set ylabel "y [um]" offset 1
set xrange [0:3.7]
set key bottom right reverse Left samplen 2
plot loop using "u":"y" with lines lw 4 lc "#bbbbbb" title "measured", \
     loop using "u":"line" with lines lw 1.5 lc "#0072b2" title "straight line", \
     loop using "u":"model" with lines lw 1.5 lc "#d55e00" title "paper's model, late"

set title "What is left of it"
set ylabel "model - measured [um]" offset 1
set key top right
set yrange [-8:12]
plot loop using "u":(column("line")-column("y")) with lines lw 1.5 lc "#0072b2" title "straight line", \
     loop using "u":(column("model")-column("y")) with lines lw 1.5 lc "#d55e00" title "paper's model, late", \
     loop using "u":(column("bent")-column("y")) with lines lw 1.5 lc "#009e73" title "and a bend"

set title "Tracking error"
set xrange [0:5]
set xlabel "t [s]"
set ylabel "y - ref [um]" offset 1
set yrange [-4:8]
plot tracking using "t":"without" with lines lw 1.2 lc "#bbbbbb" title "measured: no inverse", \
     tracking using "t":"published" with lines lw 1.2 lc "#0072b2" title "measured: published inverse", \
     tracking using "t":"ours" with lines lw 1.2 lc "#d55e00" title "predicted: ours, with the bend"
unset multiplot
