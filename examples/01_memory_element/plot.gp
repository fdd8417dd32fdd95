# Figs. 2 to 6 of the paper. Called with the folder of the records: gnuplot -c plot.gp FOLDER
set terminal pngcairo size 1200,730 font "DejaVu Sans,11" linewidth 1.1
set output ARG1."/memory_element.png"
set datafile separator comma
loop = ARG1."/memory_element.csv"
gradient = ARG1."/memory_element_gradient.csv"
printed = ARG1."/memory_element_as_printed.csv"

# Columns: t, U, Y, U_RATE, Y_RATE, MODEL_RATE, P, SLOPE, TURNED, BRANCH. Branch 0 is the skeleton curve.
on(i, x) = column("BRANCH") == i ? x : NaN
array colours[7] = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
t_i(i) = 0.25 + 0.5 * i

set key off
set grid lc "#dddddd" lw 0.7
set border 3 lw 0.8
set tics nomirror out
set multiplot layout 2,3 margins 0.055,0.985,0.085,0.935 spacing 0.075,0.135

set xlabel "t [s]"
set xrange [0:3]
do for [i=0:5] {
  set arrow i+1 from t_i(i), graph 0 to t_i(i), graph 1 nohead dt 3 lc "#888888"
  set label i+1 sprintf("t_%d", i+1) at t_i(i), graph 0.04 offset 0.4,0 textcolor "#555555"
}
set title "Fig. 2: the input reverses at t_1 … t_6"
set ylabel "u [V]" offset 1
set yrange [-330:300]
plot for [i=0:6] loop using "t":(on(i, column("U [V]"))) with lines lw 2 lc rgb colours[i+1]

set title "Fig. 2: the output"
set ylabel "y [µm]" offset 1
set yrange [-2.1:2]
plot for [i=0:6] loop using "t":(on(i, column("Y [m]")*1e6)) with lines lw 2 lc rgb colours[i+1]

set title "Fig. 6: the momentum, anew from each t_i"
set ylabel "p = |u - u_i| [V]" offset 1
set yrange [0:580]
do for [i=1:6] { set label i at t_i(i-1), graph 0.94 }
plot for [i=0:6] loop using "t":(on(i, column("P [V]"))) with lines lw 2 lc rgb colours[i+1]
unset arrow
unset label

set title "Fig. 3: many outputs to one input"
set xlabel "u [V]"
set ylabel "y [µm]" offset 1
set xrange [-280:280]
set yrange [-2:2]
set key top left reverse Left samplen 2
plot printed using "U [V]":(column("Y [m]")*1e6) with lines lw 1.5 dt 4 lc "#999999" title "α as printed: no loop", \
     loop using (on(0, column("U [V]"))):(column("Y [m]")*1e6) with lines lw 2 dt 2 lc "#000000" title "skeleton curve (2)", \
     for [i=1:6] loop using (on(i, column("U [V]"))):(column("Y [m]")*1e6) with lines lw 2 lc rgb colours[i+1] \
       title (i == 1 ? "branches (3)" : "")

set key off
set title "Fig. 4: the rates pass zero together"
set xlabel "du/dt [V/s]"
set ylabel "dy/dt [µm/s]" offset 1
set xrange [-1700:1700]
set yrange [*:*]
plot for [i=0:6] loop every ::1 using (on(i, column("U_RATE [V/s]"))):(column("Y_RATE [m/s]")*1e6) with lines lw 2 lc rgb colours[i+1]

set title "Fig. 5: one gradient to one momentum"
set xlabel "p [V]"
set ylabel "dy/du [nm/V]" offset 1
set xrange [0:520]
set yrange [0:12.5]
set label 1 "Each branch is lifted by 0.25 nm/V;\nin truth all lie on C1 + C2·p." at graph 0.05, graph 0.93 textcolor "#555555"
plot for [i=0:6] gradient using (on(i, column("P"))):(column("GRADIENT")*1e9 + 0.25*i) with lines lw 2 lc rgb colours[i+1]
unset multiplot
