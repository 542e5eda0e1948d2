# The picture of the README: points, the file of a run; picture, the file to write.
set datafile separator ','
set terminal pngcairo size 620,440 font ',10'
set output picture
set xlabel 'characteristic time [us]'
set ylabel 'restitution at 48.77 m/s'
set xrange [190:380]
set key bottom right
of(material) = strcol('face.plate.material') eq material ? column('face_restitution') : NaN
plot 0.718 + 0.000436 * x lt 3 lw 1.8 title "the rules' line", 0.710 + 0.000436 * x lt 3 dt 2 title '0.008 below', \
     points using 'characteristic_time_us':(of('titanium')) with points lt 1 pt 6 title 'titanium', \
     points using 'characteristic_time_us':(of('maraging-steel')) with points lt 2 pt 7 title 'maraging steel'
