# The picture of the README: slopes, the file of what `./slopes OUT` prints; picture, the file to write.
set datafile separator ','
set terminal pngcairo size 900,560 font ',10'
set output picture
set style data xerrorbars
unset key
set yrange [0.5:5.5]
set ytics ('measured' 5, 'rigid-eccentric' 4, 'volumetric' 3, 'fe-free-body' 2, 'fe-full-club' 1)
set offsets graph 0.05, graph 0.05, 0, 0
height(name) = name eq 'measured' ? 5 : name eq 'rigid-eccentric' ? 4 : name eq 'volumetric' ? 3 : name eq 'fe-free-body' ? 2 : 1
is(output, over) = strcol(1) eq output && strcol(2) eq over ? column(4) : NaN
colour(name) = name eq 'measured' ? 0xd55e00 : 0x0072b2
set multiplot layout 2,2
set xtics 20
set title 'sidespin towards the toe [rpm/mm]'
plot slopes using (is('sidespin_rpm', 'toe')):(height(strcol(3))):5:(colour(strcol(3))) lc rgb variable lw 2 pt 7
set xtics autofreq
set title 'ball speed towards the toe [m/s per mm]'
plot slopes using (is('ball_speed_mps', 'toe')):(height(strcol(3))):5:(colour(strcol(3))) lc rgb variable lw 2 pt 7
set xtics 50
set title 'backspin up the face [rpm/mm]'
plot slopes using (is('backspin_rpm', 'up')):(height(strcol(3))):5:(colour(strcol(3))) lc rgb variable lw 2 pt 7
set xtics autofreq
set title 'ball speed up the face [m/s per mm]'
plot slopes using (is('ball_speed_mps', 'up')):(height(strcol(3))):5:(colour(strcol(3))) lc rgb variable lw 2 pt 7
unset multiplot
