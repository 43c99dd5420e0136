// ${file}: ${description}
// Auth: ${generator}, by: ${command}
// One closed surface of ${triangles} triangles, in millimetres. Extent: ${extent}
// That is what is written of more than ${quick} vessels, which OpenSCAD would take minutes to unite; of any number
// corcast scene --scad parametric writes modules, with radii and wall in the customizer.
//
// F6 makes a solid of it at once, and so does, without a window:
//   openscad -o ${output} ${input}
// Cutting it, or uniting it with other things, takes CGAL about ${seconds} s.

/* [Part] */
// What to make
part = "tree"; // [tree:the tree as a solid, half:what of it lies behind the plane z = cut, outline:its shadow from the front to cut out (.svg or .dxf)]
// Where the half ends, mm
cut = ${middle};

/* [Look] */
// Of the preview; a solid has no color
vessel_color = [0.78, 0.26, 0.24];

/* [Hidden] */
low = ${low};
high = ${high};
points = [
${points}];
faces = [
${faces}];

module tree() {
  color(vessel_color) polyhedron(points, faces, convexity = 10);
}

module show() {
  if (part == "half")
    intersection() {
      tree();
      translate(low - [1, 1, 1]) cube([high[0] - low[0] + 2, high[1] - low[1] + 2, cut - low[2] + 1]);
    }
  else if (part == "outline")
    projection() tree();
  else if (part != "none")
    tree();
}

show();
