# Fig. 9 of the paper and what stands behind it. Called with the folder: gnuplot -c plot.gp FOLDER
set terminal pngcairo size 1200,760 font "DejaVu Sans,11" linewidth 1.1
set output ARG1."/feedforward.png"
set datafile separator comma
spring = ARG1."/linear_spring.csv"
closed = ARG1."/closed_form.csv"
order = ARG1."/order.csv"
y(name) = column(name)*1e6
e(scale) = (column("Y [m]") - column("Y_REF [m]"))*scale

set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set multiplot layout 2,2 margins 0.075,0.985,0.08,0.945 spacing 0.1,0.14
set key top right reverse Left samplen 2

set title "Fig. 9: the feedforward follows, the spring does not"
set xlabel "t [s]"
set ylabel "y [µm]" offset 1
set xrange [0:2]
set yrange [-2.2:3]
plot spring using "t":(y("Y [m]")) with lines lw 2 lc "#d55e00" title "linear spring", \
     closed using "t":(y("Y [m]")) with lines lw 3 lc "#009e73" title "feedforward of the hysteresis", \
     closed using "t":(y("Y_REF [m]")) with lines lw 1.5 dt 2 lc "#000000" title "reference (20)"

set title "The loop that the spring leaves"
set xlabel "reference [µm]"
set ylabel "y [µm]" offset 1
set xrange [-1.8:1.8]
set yrange [-2:2.6]
set key top left
plot spring using (y("Y_REF [m]")):(y("Y [m]")) with lines lw 2 lc "#d55e00" title "linear spring", \
     closed using (y("Y_REF [m]")):(y("Y [m]")) with lines lw 2.5 lc "#009e73" title "feedforward of the hysteresis"

set title "Error of the feedforward by its form"
set logscale xy
set format y "10^{%L}"
set xlabel "sample time [ms]"
set ylabel "RMS error over the range" offset 0.5
set xrange [0.2:5]
set yrange [1e-17:10]
set xtics (0.25, 0.5, 1, 2, 4)
set key off
set label 1 "linear spring" at 0.25, 1.2 textcolor "#d55e00"
set label 2 "ODE form, forward Euler: order 1" at 0.25, 1.5e-5 textcolor "#0072b2"
set label 3 "ODE form, Heun: order 3 where C3 = 1" at 0.6, 1.2e-10 textcolor "#cc79a7"
set label 4 "closed form: rounding alone" at 0.25, 3e-15 textcolor "#009e73"
plot order using (column("sample_time")*1e3):"linear_spring" with linespoints pt 7 lw 2 lc "#d55e00", \
     order using (column("sample_time")*1e3):"ode_form" with linespoints pt 7 lw 2 lc "#0072b2", \
     order using (column("sample_time")*1e3):"heun_form" with linespoints pt 7 lw 2 lc "#cc79a7", \
     order using (column("sample_time")*1e3):"closed_form" with linespoints pt 7 lw 2 lc "#009e73"
unset label
set key on
unset logscale
set format y "%g"
set xtics autofreq

set title "A disturbance of 0.1 µm from 1 s on: feedback K removes it"
set xlabel "t [s]"
set ylabel "y - reference [nm]"
set xrange [0.8:2]
set yrange [-20:140]
set key top right
plot ARG1."/servo_open.csv" using "t":(e(1e9)) with lines lw 2 lc "#0072b2" title "F alone, K = 0", \
     ARG1."/servo_closed.csv" using "t":(e(1e9)) with lines lw 2 lc "#cc79a7" title "F and K"
unset multiplot
