RASTER 800 600
RTDEPTH 1                (* nothing mirrors *)
AMBIENT 0.35 0.35 0.35
SKY     0.80 0.86 0.92   (* seen from above: only EARTH shows *)
EARTH   0.92 0.92 0.90
ANTI-ALIAS
