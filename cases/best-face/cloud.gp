# The picture of the README: points, the file of a run; picture, the file to write.
set datafile separator ','
set terminal pngcairo size 760,480 font ',10'
set output picture
set xlabel 'characteristic time at the centre [us]'
set ylabel 'ball speed, mean over nine places [m/s]'
set cblabel 'largest stress [MPa]'
set palette defined (0 '#2c7bb6', 1 '#abd9e9', 2 '#fdae61', 3 '#d7191c')
set key bottom right
set arrow from 257, graph 0 to 257, graph 1 nohead dt 2
set label '257 us' at 257, graph 0.04 offset 0.6
plot points using 'characteristic_time_us':'mean_ball_speed_mps':'peak_stress_MPa' with points pt 7 ps 0.9 palette \
     notitle
