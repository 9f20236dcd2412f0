// Under-expanded jet from a choked nozzle of 0.46 mm: the half plane behind the exit, x the axis, y the distance from it,
// in mm (-mesh_scale 0.001). Even cells of 12.5 um around the first shock cell, growing outwards.
// gmsh -2 -format msh22 inputs/fluid/jet_underexpanded.geo -o inputs/fluid/jet_underexpanded.msh
If(!Exists(n)) n = 1; EndIf // cells per cell of the committed mesh, each way
R = 0.23; X[] = {0, 1.25, 10}; Y[] = {0, R, 0.7, 4};
For j In {0:3}
  For i In {0:2}
    Point(10 * j + i + 1) = {X[i], Y[j], 0};
  EndFor
EndFor
nx[] = {100 * n, 64 * n}; gx[] = {1, 1 + 0.0395 / n};
ny[] = {18 * n, 30 * n, 24 * n}; gy[] = {1, 1 + 0.0137 / n, 1 + 0.148 / n};
For j In {0:3}
  For i In {0:1}
    Line(100 + 10 * j + i) = {10 * j + i + 1, 10 * j + i + 2};
    Transfinite Curve {100 + 10 * j + i} = nx[i] + 1 Using Progression gx[i];
  EndFor
EndFor
For j In {0:2}
  For i In {0:2}
    Line(200 + 10 * j + i) = {10 * j + i + 1, 10 * (j + 1) + i + 1};
    Transfinite Curve {200 + 10 * j + i} = ny[j] + 1 Using Progression gy[j];
  EndFor
EndFor
For j In {0:2}
  For i In {0:1}
    s = 300 + 10 * j + i;
    Curve Loop(s) = {100 + 10 * j + i, 200 + 10 * j + i + 1, -(100 + 10 * (j + 1) + i), -(200 + 10 * j + i)};
    Plane Surface(s) = {s};
    Transfinite Surface {s};
    Recombine Surface {s};
  EndFor
EndFor
Physical Curve("nozzle") = {200};
Physical Curve("plate") = {210, 220};
Physical Curve("axis") = {100, 101};
Physical Curve("around") = {130, 131};
Physical Curve("outlet") = {202, 212, 222};
Physical Surface("gas") = {300, 301, 310, 311, 320, 321};
