// Sonic orifice of 1 mm: the half plane behind it, x the axis, y the distance from it, in mm (-mesh_scale 0.001). Even
// cells of 25 um/n (20 n to the radius) as far as the Mach disk and the jet's edge, growing outwards.
// gmsh -2 -format msh22 inputs/fluid/underexpanded_orifice.geo -o output/meshes/underexpanded_orifice.msh
If(!Exists(n)) n = 0.7; EndIf // cells each way, of those of 25 um
X[] = {0, 4.4, 14}; Y[] = {0, 0.5, 1.9, 7};
For j In {0:3}
  For i In {0:2}
    Point(10 * j + i + 1) = {X[i], Y[j], 0};
  EndFor
EndFor
nx[] = {176 * n, 70 * n}; gx[] = {1, 1 + 0.0411 / n};
ny[] = {20 * n, 56 * n, 36 * n}; gy[] = {1, 1, 1 + 0.084 / n};
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
Physical Curve("axis") = {100, 101};
Physical Curve("around") = {130, 131, 202, 212, 222, 210, 220}; // everything else is open
Physical Surface("gas") = {300, 301, 310, 311, 320, 321};
