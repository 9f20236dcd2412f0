// Ring between r = 1 and r = 2: gmsh -2 -format msh22 taylor_couette.geo
SetFactory("Built-in");
n = 16; m = 14;
Point(0) = {0, 0, 0};
For k In {0:3}
  Point(1 + k) = {Cos(k*Pi/2), Sin(k*Pi/2), 0};
  Point(5 + k) = {2*Cos(k*Pi/2), 2*Sin(k*Pi/2), 0};
EndFor
For k In {0:3}
  Circle(1 + k) = {1 + k, 0, 1 + (k + 1) % 4};
  Circle(5 + k) = {5 + k, 0, 5 + (k + 1) % 4};
  Line(9 + k) = {1 + k, 5 + k};
EndFor
Transfinite Curve {1:8} = 2*n + 1;
Transfinite Curve {9:12} = m + 1;
For k In {0:3}
  Curve Loop(1 + k) = {9 + k, 5 + k, -(9 + (k + 1) % 4), -(1 + k)};
  Plane Surface(1 + k) = {1 + k};
  Transfinite Surface {1 + k};
  Recombine Surface {1 + k};
EndFor
Physical Curve("inner") = {1:4};
Physical Curve("outer") = {5:8};
Physical Surface("fluid") = {1:4};
