// DFG benchmark 2D-1 (Schaefer & Turek 1996): channel 2.2 x 0.41 m with a cylinder of diameter 0.1 m at (0.2, 0.2).
// Regenerate: gmsh -2 -format msh41 dfg_2d1.geo
// Cell sizes: cylinder, its wake, far channel. The wall nodes resolve the boundary layers that feed the drag.
cylinder_size = 0.0025;
wake_size = 0.011;
channel_size = 0.024;
Point(1) = {0, 0, 0, channel_size};
Point(2) = {2.2, 0, 0, channel_size};
Point(3) = {2.2, 0.41, 0, channel_size};
Point(4) = {0, 0.41, 0, channel_size};
Point(5) = {0.2, 0.2, 0, cylinder_size};
Point(6) = {0.25, 0.2, 0, cylinder_size};
Point(7) = {0.2, 0.25, 0, cylinder_size};
Point(8) = {0.15, 0.2, 0, cylinder_size};
Point(9) = {0.2, 0.15, 0, cylinder_size};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Circle(5) = {6, 5, 7};
Circle(6) = {7, 5, 8};
Circle(7) = {8, 5, 9};
Circle(8) = {9, 5, 6};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1, 2};
Physical Curve("inlet") = {4};
Physical Curve("outlet") = {2};
Physical Curve("wall") = {1, 3};
Physical Curve("cylinder") = {5, 6, 7, 8};
Physical Surface("fluid") = {1};

// Distance from the cylinder grades the mesh; a box keeps the near wake fine.
Field[1] = Distance;
Field[1].CurvesList = {5, 6, 7, 8};
Field[1].Sampling = 200;
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = cylinder_size;
Field[2].SizeMax = channel_size;
Field[2].DistMin = 0.004;
Field[2].DistMax = 0.35;
Field[3] = Box;
Field[3].VIn = wake_size;
Field[3].VOut = channel_size;
Field[3].XMin = 0;
Field[3].XMax = 0.7;
Field[3].YMin = 0;
Field[3].YMax = 0.41;
Field[3].Thickness = 0.3;
Field[4] = Min;
Field[4].FieldsList = {2, 3};
Background Field = 4;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 6;
