// Flat plate from x = 0 to 2 below a stream of height 1, with a third of free stream ahead of it: quadrilaterals graded
// towards the wall and the leading edge. gmsh -2 -format msh22 -o flat_plate.msh [-setnumber level 2] flat_plate.geo
// level 1: 73 x 65 nodes, first node at y+ = 0.3; each level halves the cells. The numbers of cells may also be given: the
// mesh of 273 x 193 nodes has -setnumber ahead 60 -setnumber along 212 -setnumber up 192 (first node at y+ = 0.1).
DefineConstant[level = 1];
m = 2^(level - 1);
DefineConstant[ahead = 16*m, along = 56*m, up = 64*m];
Point(1) = {-1/3, 0, 0}; Point(2) = {0, 0, 0}; Point(3) = {2, 0, 0};
Point(4) = {2, 1, 0}; Point(5) = {0, 1, 0}; Point(6) = {-1/3, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {5, 4}; Line(5) = {6, 5}; Line(6) = {1, 6}; Line(7) = {2, 5};
Transfinite Curve {1, 5} = ahead + 1 Using Progression 1/1.35^(16/ahead);
Transfinite Curve {2, 4} = along + 1 Using Progression 1.1^(56/along);
Transfinite Curve {3, 6, 7} = up + 1 Using Progression 1.2^(64/up);
Curve Loop(1) = {1, 7, -5, -6}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, -4, -7}; Plane Surface(2) = {2};
Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Physical Curve("ahead") = {1}; Physical Curve("plate") = {2}; Physical Curve("outlet") = {3};
Physical Curve("top") = {4, 5}; Physical Curve("inlet") = {6};
Physical Surface("fluid") = {1, 2};
