// Round jet of diameter 1 (-mesh_scale the diameter in m): the half plane around the end of its nozzle, x the axis, y the
// distance from it. The nozzle reaches 1 D into the mesh, its wall has friction over the last 0.25 D and a lip of 0.015 D;
// 40 D long, 15 D wide; cells of 0.003 D at the wall, growing along and outwards.
// gmsh -2 -format msh22 inputs/fluid/round_jet.geo -o output/meshes/round_jet.msh
If(!Exists(n)) n = 0.85; EndIf // factor of the number of cells each way
X[] = {-1, -0.25, 0, 40}; Y[] = {0, 0.5, 0.515, 15};
For j In {0:3}
  For i In {0:3}
    Point(10 * j + i + 1) = {X[i], Y[j], 0};
  EndFor
EndFor
nx[] = {12 * n, 13 * n, 144 * n}; gx[] = {1 / (1 + 0.05 / n), 1 / (1 + 0.09 / n), 1 + 0.035 / n};
ny[] = {40 * n, 6 * n, 74 * n}; gy[] = {1 / (1 + 0.078 / n), 1, 1 + 0.086 / n};
For j In {0:3}
  For i In {0:2}
    Line(100 + 10 * j + i) = {10 * j + i + 1, 10 * j + i + 2};
    Transfinite Curve {100 + 10 * j + i} = nx[i] + 1 Using Progression gx[i];
  EndFor
EndFor
For j In {0:2}
  For i In {0:3}
    If (i > 1 || j != 1)
      Line(200 + 10 * j + i) = {10 * j + i + 1, 10 * (j + 1) + i + 1};
      Transfinite Curve {200 + 10 * j + i} = ny[j] + 1 Using Progression gy[j];
    EndIf
  EndFor
EndFor
For j In {0:2}
  For i In {0:2}
    If (i > 1 || j != 1) // no gas between the walls of the nozzle
      s = 300 + 10 * j + i;
      Curve Loop(s) = {100 + 10 * j + i, 200 + 10 * j + i + 1, -(100 + 10 * (j + 1) + i), -(200 + 10 * j + i)};
      Plane Surface(s) = {s};
      Transfinite Surface {s};
      Recombine Surface {s};
    EndIf
  EndFor
EndFor
Physical Curve("nozzle") = {200};
Physical Curve("smooth") = {110, 120, 121};
Physical Curve("wall") = {111, 212};
Physical Curve("axis") = {100, 101, 102};
Physical Curve("around") = {130, 131, 132, 220, 203, 213, 223};
Physical Surface("gas") = {300, 301, 302, 312, 320, 321, 322};
