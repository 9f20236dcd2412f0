// Vessel of the buoyant pebble bed: a cylinder of D/d = 16.24 with a round inlet in the middle of its base, axis z (m).
// Regenerate: gmsh -3 -format msh41 buoyant_bed.geo
diameter = 0.4125;
inlet = 0.1;      // diameter of the inlet
height = 1.45;
cell = 0.042;
layers = 42;

Point(1) = {0, 0, 0, cell};
For k In {0 : 3}
  Point(10 + k) = {inlet / 2 * Cos(k * Pi / 2), inlet / 2 * Sin(k * Pi / 2), 0, cell};
  Point(20 + k) = {diameter / 2 * Cos(k * Pi / 2), diameter / 2 * Sin(k * Pi / 2), 0, cell};
EndFor
For k In {0 : 3}
  Circle(10 + k) = {10 + k, 1, 10 + (k + 1) % 4};
  Circle(20 + k) = {20 + k, 1, 20 + (k + 1) % 4};
EndFor
Curve Loop(1) = {10, 11, 12, 13};
Curve Loop(2) = {20, 21, 22, 23};
Plane Surface(1) = {1};
Plane Surface(2) = {2, 1};
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 1;
Recombine Surface {1, 2};
inner[] = Extrude {0, 0, height} { Surface{1}; Layers{layers}; Recombine; };
outer[] = Extrude {0, 0, height} { Surface{2}; Layers{layers}; Recombine; };
Physical Volume("fluid") = {inner[1], outer[1]};
Physical Surface("inlet") = {1};
Physical Surface("base") = {2};
Physical Surface("outlet") = {inner[0], outer[0]};
Physical Surface("wall") = {outer[2], outer[3], outer[4], outer[5]};
