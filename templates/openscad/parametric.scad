// ${file}: ${description}
// Auth: ${generator}, by: ${command}
// ${count} vessels in millimetres, as modules. Extent: ${extent}
// Of more than ${quick} vessels one closed surface is written instead, unless corcast scene --scad parametric asks for
// modules.
//
// Open it and change what Window > Customizer shows; F5 shows the result at once, F6 makes it a solid. Or without
// a window:
//   openscad -o ${output} ${input}
//   openscad -o ${output} -D 'part="wall"' -D wall=0.8 ${input}
// CGAL, which unites the vessels, takes about ${seconds} s for all of them with $$fn = 12, and more with the square of $$fn.

/* [Part] */
// What to make
part = "tree"; // [tree:the tree as a solid, wall:its wall about the empty tree, block:a block without the tree, outline:its shadow from the front to cut out (.svg or .dxf), vessels:cylinders alone, bifurcations:what joins them alone]
// Leave out vessels thinner than this, mm
min_radius = 0; // [0:0.05:${max_radius}]

/* [Size] */
// Factor on all radii
radius_scale = 1; // [0.25:0.05:4]
// Thickness of the wall, mm
wall = 0.8; // [0.1:0.1:5]
// Cut the wall open where vessels end
open_ends = true;
// From the tree to the sides of the block, mm
margin = 3; // [0.5:0.5:20]

/* [Quality] */
// Sides of a vessel
$$fn = 12; // [6:2:64]

/* [Look] */
// Of the preview; a solid has no color
vessel_color = ${color}; // linear

/* [Hidden] */
// Where the coordinates below begin in those of the tree.
origin = ${origin};
low = ${low};
high = ${high};

// Set about tree(): what it draws, and how much thicker than the tree.
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

// A segment of the tree, straight from a to b; id is its number in the tree's file.
module vessel(id, a, b, radius, c = vessel_color) {
  if ($$vessels && radius >= min_radius)
    color(srgb(c)) translate(a) along(b - a) cylinder(h = norm(b - a), r = drawn(radius));
}

module joint(p, radius, c) {
  if ($$joints && radius >= min_radius) color(srgb(c)) translate(p) sphere(r = drawn(radius));
}

// Where three or more vessels meet; where two do; where one ends, there heading for v.
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

translate(origin) show();
