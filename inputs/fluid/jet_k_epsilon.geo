// Under-expanded jet from a choked nozzle of 0.46 mm into still air: the half plane behind the exit, x the axis, y the
// distance from it, in mm (-mesh_scale 0.001). Even cells of 12.5 um/n around the first shock cell, growing outwards.
// gmsh -2 -format msh22 -setnumber n 0.66 inputs/fluid/jet_k_epsilon.geo -o inputs/fluid/jet_k_epsilon.msh
If(!Exists(n)) n = 1; EndIf // cells each way, of those of 12.5 um; the committed mesh has 0.66 of them, 8,008 nodes
R = 0.23; X[] = {0, 1.25, 30}; Y[] = {0, R, 0.8, 12};
For j In {0:3}
  For i In {0:2}
    Point(10 * j + i + 1) = {X[i], Y[j], 0};
  EndFor
EndFor
nx[] = {100 * n, 116 * n}; gx[] = {1, 1 + 0.0395 / n};
ny[] = {18 * n, 34 * n, 34 * n}; gy[] = {1, 1 + 0.0165 / n, 1 + 0.125 / n};
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
