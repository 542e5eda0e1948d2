# The picture of the README: run, the folder of `hosel run rollback`; laws, that of `hosel run rollback/laws`; picture, the file
# to write. Published bars: the announced losses of [@ball-rule], as in the README's table.
set datafile separator ','
set terminal pngcairo size 760,520 font ',10'
set output picture
set xlabel 'club speed [mph]'
set ylabel 'loss of total distance [yd]'
set key below center horizontal Left reverse samplen 2 maxrows 3
set xrange [68:131]
set yrange [0:36]
$published << EOD
127,13,15
115,9,11
94,5,7
93,0,5
72,0,5
EOD
parts = run . '/parts.csv'
part(name, player) = strcol('part') eq name ? column(player) : NaN
# A law is a row, its losses columns in the order of the players: the range of all laws, one player at a time.
array speed[6] = [127, 115, 105, 94, 93, 72]
set print $band
do for [k = 1:6] {
  stats laws . '/points.csv' using k + 2 every ::1 nooutput
  print sprintf('%g,%g,%g', speed[k], STATS_min, STATS_max)
}
unset print
plot $band using 1:3 with lines dt 2 lc rgb '#0072b2' title 'by drag, lowest and highest of eight laws', \
     $band using 1:2 with lines dt 2 lc rgb '#0072b2' notitle, \
     parts using (part('lost by more drag', 'delivery.club_speed_mph')):'total_yd' with linespoints lw 1.8 pt 7 lc rgb '#0072b2' title 'by drag', \
     parts using (part('lost by less lift', 'delivery.club_speed_mph')):'total_yd' with linespoints lw 1.8 pt 5 lc rgb '#d55e00' title 'by lift', \
     parts using (part('lost by less speed', 'delivery.club_speed_mph')):'total_yd' with linespoints lw 1.8 pt 9 lc rgb '#009e73' title 'by speed', \
     $published using 1:(($2 + $3) / 2):2:3 with yerrorbars lw 2 pt 0 lc rgb '#000000' title 'published for such players'
