RASTER 800 600
RTDEPTH 3
AMBIENT 0.2 0.2 0.2
SKY     0.9 0.9 1.0      (* HORIZON and EARTH are missing: both as SKY *)
(* no SHADOWS: each ball is to be seen by itself *)
ANTI-ALIAS
