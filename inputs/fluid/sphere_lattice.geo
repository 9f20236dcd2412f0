// A cube of 1 m about a sphere of 0.310175 m (an eighth of the cube), every side repeating the opposite one; m.
// gmsh -3 -format msh22 inputs/fluid/sphere_lattice.geo -o output/meshes/sphere_lattice.msh
SetFactory("OpenCASCADE");
If(!Exists(h)) h = 0.1; EndIf // width of the cells at the sides, half of that on the sphere
Box(1) = {-0.5, -0.5, -0.5, 1, 1, 1};
Sphere(2) = {0, 0, 0, (3 * 0.125 / (4 * Pi))^(1 / 3)};
fluid() = BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; };
e = 1e-3;
left() = Surface In BoundingBox{-0.5 - e, -0.5 - e, -0.5 - e, -0.5 + e, 0.5 + e, 0.5 + e};
right() = Surface In BoundingBox{0.5 - e, -0.5 - e, -0.5 - e, 0.5 + e, 0.5 + e, 0.5 + e};
front() = Surface In BoundingBox{-0.5 - e, -0.5 - e, -0.5 - e, 0.5 + e, -0.5 + e, 0.5 + e};
back() = Surface In BoundingBox{-0.5 - e, 0.5 - e, -0.5 - e, 0.5 + e, 0.5 + e, 0.5 + e};
low() = Surface In BoundingBox{-0.5 - e, -0.5 - e, -0.5 - e, 0.5 + e, 0.5 + e, -0.5 + e};
high() = Surface In BoundingBox{-0.5 - e, -0.5 - e, 0.5 - e, 0.5 + e, 0.5 + e, 0.5 + e};
ball() = Surface In BoundingBox{-0.4, -0.4, -0.4, 0.4, 0.4, 0.4};
Periodic Surface {right()} = {left()} Translate {1, 0, 0};
Periodic Surface {back()} = {front()} Translate {0, 1, 0};
Periodic Surface {high()} = {low()} Translate {0, 0, 1};
MeshSize{ PointsOf{ Volume{fluid()}; } } = h;
MeshSize{ PointsOf{ Surface{ball()}; } } = h / 2;
Mesh.MeshSizeExtendFromBoundary = 1;
Physical Surface("sphere") = {ball()};
Physical Surface("sides") = {left(), right(), front(), back(), low(), high()};
Physical Volume("fluid") = {fluid()};
