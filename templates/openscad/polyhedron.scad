// ${file}: ${description}
// Auth: ${generator}, by: ${command}
// One closed surface of ${triangles} triangles, in millimetres. Extent: ${extent}
// corcast writes this form for more than ${quick} vessels, which OpenSCAD would take minutes to unite. For any number of
// vessels, corcast scene --scad parametric writes modules, with radii and wall in the customizer.
//
// F6 makes it a solid at once. From the command line:
//   openscad -o ${output} ${input}
// Cutting it, or uniting it with other objects, takes CGAL about ${seconds} s.

/* [Part] */
// What to make
part = "tree"; // [tree:the tree as a solid, half:the half behind the plane z = cut, outline:its outline from the front (.svg or .dxf)]
// z at which the half ends, mm
cut = ${middle};

/* [Look] */
// Color of the preview; a solid has no color
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
