// ${file}: ${description}
// Auth: ${generator}, by: ${command}
// ${count} vessels in millimetres, as modules. Extent: ${extent}
// For more than ${quick} vessels corcast writes one closed surface instead, unless corcast scene --scad parametric
// requests modules.
//
// Open the file and change the values in Window > Customizer. F5 previews the result at once; F6 makes it a solid. From
// the command line:
//   openscad -o ${output} ${input}
//   openscad -o ${output} -D 'part="wall"' -D wall=0.8 ${input}
// CGAL, which unites the vessels, takes about ${seconds} s with $$fn = 12. The time grows with the square of $$fn.

/* [Part] */
// What to make
part = "tree"; // [tree:the tree as a solid, wall:a wall around the empty tree, block:a block with the tree removed, outline:its outline from the front (.svg or .dxf), vessels:only the cylinders, bifurcations:only the joining balls]
// Leave out vessels thinner than this, mm
min_radius = 0; // [0:0.05:${max_radius}]

/* [Size] */
// Factor on all radii
radius_scale = 1; // [0.25:0.05:4]
// Thickness of the wall, mm
wall = 0.8; // [0.1:0.1:5]
// Cut the wall open where vessels end
open_ends = true;
// Distance from the tree to the sides of the block, mm
margin = 3; // [0.5:0.5:20]

/* [Quality] */
// Number of sides of a vessel in the preview
preview_sides = 24; // [6:2:64]
// Number of sides of a vessel in the solid
$$fn = 12; // [6:2:64]

/* [Look] */
// Color of the preview; a solid has no color
vessel_color = ${color}; // linear

/* [Nodes and radii] */
// p7 is the node that segment 7 leads to, start7 the node where segment 7 begins if it is the root, and r7 the radius of
// segment 7, all in mm. Vessels, joints and ends follow from them.
${variables}
/* [Hidden] */
// The origin of the coordinates above, in the tree's coordinates.
origin = ${origin};
// The ends of all vessels, as pairs of a node and a radius, and the box around them.
ends = [
${ends}];
low = [for (k = [0:2]) min([for (e = ends) e[0][k] - drawn(e[1])])];
high = [for (k = [0:2]) max([for (e = ends) e[0][k] + drawn(e[1])])];

// Special variables that control tree(): which parts it draws, and how much thicker than the tree.
$$vessels = true;
$$joints = true;
$$openings = false;
$$thicker = 0;

function srgb(c) = [for (v = c) v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055];
function drawn(radius) = radius * radius_scale + $$thicker;

// Turns the z axis along a vector.
module along(v) {
  rotate([0, acos(v[2] / norm(v)), atan2(v[1], v[0])]) children();
}

// A segment of the tree, straight from node a to node b; id is its id in the tree's file.
module vessel(id, a, b, radius, c = vessel_color) {
  if ($$vessels && radius >= min_radius)
    color(srgb(c)) translate(a) along(b - a) cylinder(h = norm(b - a), r = drawn(radius));
}

module joint(p, radius, c) {
  if ($$joints && radius >= min_radius) color(srgb(c)) translate(p) sphere(r = drawn(radius));
}

// Where three or more vessels meet; where two do; where one ends, and leaves in the direction v.
module bifurcation(p, radius, c = vessel_color) { joint(p, radius, c); }
module bend(p, radius, c = vessel_color) { joint(p, radius, c); }
module end(p, radius, v, c = vessel_color) {
  joint(p, radius, c);
  if ($$openings && radius >= min_radius)
    translate(p) along(v) cylinder(h = 2 * (drawn(radius) + wall), r = drawn(radius));
}

module tree() {
${calls}}

module show() {
  if (part == "wall")
    difference() {
      tree($$thicker = wall);
      tree($$openings = open_ends);
    }
  else if (part == "block")
    difference() {
      translate(low - margin * [1, 1, 1]) cube(high - low + 2 * margin * [1, 1, 1]);
      tree($$openings = open_ends);
    }
  else if (part == "outline")
    projection() tree();
  else if (part != "none")
    tree($$vessels = part != "bifurcations", $$joints = part != "vessels");
}

translate(origin) show($$fn = $$preview ? preview_sides : $$fn);
