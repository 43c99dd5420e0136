// Persistence of Vision Ray Tracer Scene Description File
// File: ${file}
// Vers: 3.7
// Desc: ${description}
// Auth: ${generator}, by: ${command}
//
// The geometry is in ${geometry_file}. This file has the camera, the lights and the background.
// Units are millimetres. The camera is given by its own vectors, so the world is right-handed:
// seen from the front, x points to the right, y up, and z towards the viewer. To change the camera, declare
// Camera_Location, Camera_Look_At and others, below.
// Extent: ${extent}
${effects}//
// Render: povray +I${input} +O${output} +W${width} +H${height} -D
// Size: ${width}x${height}
//
// Every value inside #ifndef can be declared before an #include of this file. Numbers can also be set on the command
// line: Declare=Light_Intensity=1.2 or Declare=Vessel_Red=0.2. For a transparent background:
// +UA Declare=Background_Transmit=1.
#version 3.7;

global_settings {
  assumed_gamma 1.0
  max_trace_level 5
}

// ---- camera ---------------------------------------------------------------------------------
// A part of the picture is the picture of a smaller camera. For example, rows 128 to 191 of ${width}x${height} are
// +W${width} +H64 Declare=Picture_Height=${height} Declare=Part_Top=128; for columns use Picture_Width and Part_Left.
// The part has exactly the pixels of the whole, also with antialiasing, except with jitter or with +AM1 and a
// threshold above 0.
#ifndef (Picture_Width)  #declare Picture_Width  = image_width; #end  // pixels of the whole picture
#ifndef (Picture_Height) #declare Picture_Height = image_height; #end
#ifndef (Part_Left)      #declare Part_Left      = 0; #end            // where the part begins, pixels
#ifndef (Part_Top)       #declare Part_Top       = 0; #end

${camera}#local Part_Place = Camera_Right * ((Part_Left + image_width / 2) / Picture_Width - 0.5)
                  - Camera_Up * ((Part_Top + image_height / 2) / Picture_Height - 0.5);

camera {
  #if (Camera_Perspective)
    perspective
    location  Camera_Location
    direction Camera_Direction + Part_Place
  #else
    orthographic
    location  Camera_Location + Part_Place
    direction Camera_Direction
  #end
  right     Camera_Right * (image_width / Picture_Width)
  up        Camera_Up * (image_height / Picture_Height)
}

// ---- background and shadows -----------------------------------------------------------------
#ifndef (Light_Shadows)       #declare Light_Shadows       = ${shadows}; #end // 1: vessels cast shadows
#ifndef (Background_Red)      #declare Background_Red      = ${background_red}; #end // linear
#ifndef (Background_Green)    #declare Background_Green    = ${background_green}; #end
#ifndef (Background_Blue)     #declare Background_Blue     = ${background_blue}; #end
#ifndef (Background_Transmit) #declare Background_Transmit = ${background_transmit}; #end
#ifndef (Background_Color)
  #declare Background_Color = rgbt <Background_Red, Background_Green, Background_Blue, Background_Transmit>;
#end
background { color Background_Color }

${?graded}
// The background changes from its color in the center of the picture to Background_Corners at the corners, linearly with
// the square of the distance from the center. It is a plane behind the vessels that casts no shadow.
#ifndef (Background_Corners) #declare Background_Corners = ${corners}; #end // linear
#local Eye_x = Camera_Location.x; #local Eye_y = Camera_Location.y; #local Eye_z = Camera_Location.z;
#local Axis_x = Camera_Direction.x; #local Axis_y = Camera_Direction.y; #local Axis_z = Camera_Direction.z;
#local Row = Camera_Right / pow(vlength(Camera_Right), 2); #local Column = Camera_Up / pow(vlength(Camera_Up), 2);
#local Row_x = Row.x; #local Row_y = Row.y; #local Row_z = Row.z;
#local Column_x = Column.x; #local Column_y = Column.y; #local Column_z = Column.z;
#local Fn_Before = function(x, y, z) { (x - Eye_x) * Axis_x + (y - Eye_y) * Axis_y + (z - Eye_z) * Axis_z };
#local Fn_Right = function(x, y, z) { (x - Eye_x) * Row_x + (y - Eye_y) * Row_y + (z - Eye_z) * Row_z };
#local Fn_Up = function(x, y, z) { (x - Eye_x) * Column_x + (y - Eye_y) * Column_y + (z - Eye_z) * Column_z };
#local Wide = pow(Picture_Width, 2); #local High = pow(Picture_Height, 2);
#declare Fn_Corners = function(x, y, z) { // a pattern's value 1 is its value 0
  min(4 * (Wide * pow(Fn_Right(x, y, z), 2) + High * pow(Fn_Up(x, y, z), 2)) / (Wide + High)
    / #if (Camera_Perspective) pow(Fn_Before(x, y, z), 2) #else 1 #end, 0.9999999)
};
#local Paper = <0, 0, 0, 0, 0> + Background_Color;
#declare P_Background = pigment {
  function { Fn_Corners(x, y, z) }
  color_map {
    [0 rgb <Paper.red, Paper.green, Paper.blue>]
    [1 color Background_Corners]
  }
};
#ifndef (Background_Graded) #declare Background_Graded = 1; #end // 0: one color
#if (Background_Graded)
  plane {
    Camera_Direction, vdot(Camera_Direction, Camera_Location) + ${distance}
    texture { pigment { P_Background } finish { ambient 1 diffuse 0 } }
    no_shadow
  }
#end

${/graded}
${?fade}
// Far vessels fade into the background: the fraction Fade_Nearest of its color at the distance Fade_Near from the
// camera, mm, rising linearly to Fade_Farthest at Fade_Far.
#ifndef (Fade_Nearest)  #declare Fade_Nearest  = ${fade_nearest}; #end
#ifndef (Fade_Farthest) #declare Fade_Farthest = ${fade_farthest}; #end
#ifndef (Fade_Near)     #declare Fade_Near     = ${fade_near}; #end
#ifndef (Fade_Far)      #declare Fade_Far      = ${fade_far}; #end
#ifndef (Vessel_Fade) // 0: no vessel fades; glass does not
  #declare Vessel_Fade = 1;
  #ifdef (Vessel_Color)
    #local Glass = <0, 0, 0, 0, 0> + Vessel_Color;
    #if (Glass.filter + Glass.transmit > 0) #declare Vessel_Fade = 0; #end
  #end
#end
#ifndef (P_Background)
  #local Paper = <0, 0, 0, 0, 0> + Background_Color;
  #declare P_Background = pigment { rgb <Paper.red, Paper.green, Paper.blue> };
#end
#declare T_Faded = texture { pigment { P_Background } finish { ambient 1 diffuse 0 } }
#local Eye_x = Camera_Location.x; #local Eye_y = Camera_Location.y; #local Eye_z = Camera_Location.z;
#local Axis_x = Camera_Direction.x; #local Axis_y = Camera_Direction.y; #local Axis_z = Camera_Direction.z;
#if (Camera_Perspective)
  #declare Fn_Distance = function(x, y, z) { sqrt(pow(x - Eye_x, 2) + pow(y - Eye_y, 2) + pow(z - Eye_z, 2)) };
#else
  #declare Fn_Distance = function(x, y, z) { (x - Eye_x) * Axis_x + (y - Eye_y) * Axis_y + (z - Eye_z) * Axis_z };
#end
#declare Fn_Fade = function(x, y, z) { // a pattern's value 1 is its value 0
  min(Fade_Nearest + (Fade_Farthest - Fade_Nearest)
    * min(max((Fn_Distance(x, y, z) - Fade_Near) / (Fade_Far - Fade_Near), 0), 1), 0.9999999)
};

${/fade}
${?tips}
// The colors of the vessels run with the radius, unless a color or a texture of the vessels was declared before.
#ifndef (Tree_Colors)
  #declare Tree_Colors = 1;
  #ifdef (T_Vessel)     #declare Tree_Colors = 0; #end
  #ifdef (Vessel_Color) #declare Tree_Colors = 0; #end
  #ifdef (Vessel_Red)   #declare Tree_Colors = 0; #end
  #ifdef (Vessel_Green) #declare Tree_Colors = 0; #end
  #ifdef (Vessel_Blue)  #declare Tree_Colors = 0; #end
#end

${/tips}
// ---- animation ------------------------------------------------------------------------------
// With Turn_Clock = 1 the tree turns once about the vertical axis of the picture while clock goes from 0 to 1.
// With Growth_Clock = 1 the tree grows from its root.
#ifndef (Turn_Clock)   #declare Turn_Clock   = 0; #end
#ifndef (Growth_Clock) #declare Growth_Clock = 0; #end
#ifndef (Tree_Turn)    #declare Tree_Turn    = Turn_Clock * clock * 360; #end // degrees
#ifndef (Tree_Growth)  #declare Tree_Growth  = (Growth_Clock ? clock : 1); #end
#macro Turn_Tree()
  #local Axis = vnormalize(Camera_Up);
  #local X = vaxis_rotate(x, Axis, Tree_Turn);
  #local Y = vaxis_rotate(y, Axis, Tree_Turn);
  #local Z = vaxis_rotate(z, Axis, Tree_Turn);
  translate -Tree_Center
  matrix <X.x, X.y, X.z, Y.x, Y.y, Y.z, Z.x, Z.y, Z.z, Tree_Center.x, Tree_Center.y, Tree_Center.z>
#end

// ---- vessels --------------------------------------------------------------------------------
// The file of the geometry has the defaults of the vessels' material: Vessel_Red, _Green, _Blue (linear) and
// Vessel_Ambient, _Diffuse, _Brilliance, _Phong, _Phong_Size, _Specular, _Roughness.
${?include}
#include "${include}"
${/include}
${!include}
${geometry}
${/include}

// ---- light ----------------------------------------------------------------------------------
// Own_Lights, a macro without arguments that is declared before, replaces the lights${?ground} and the ground${/ground} below. It can use
// Camera_Location, Camera_Direction, Tree_Center and Tree_Radius.
#ifdef (Own_Lights)
  Own_Lights()
#else
  #ifndef (Light_Intensity) #declare Light_Intensity = 1; #end
${?parallel}
  #macro Light_Parallel(Location, Target, Color)
    light_source { Location, rgb Color * Light_Intensity parallel point_at Target }
  #end
${/parallel}
${?point}
  #macro Light_Point(Location, Color)
    light_source { Location, rgb Color * Light_Intensity }
  #end
${/point}
${?area}
  #macro Light_Area(Location, Color, Side_A, Side_B, Samples)
    light_source { Location, rgb Color * Light_Intensity area_light Side_A, Side_B, Samples, Samples }
  #end
${/area}
${?disc}
  #macro Light_Disc(Location, Color, Side_A, Side_B, Samples)
    light_source { Location, rgb Color * Light_Intensity area_light Side_A, Side_B, Samples, Samples circular }
  #end
${/disc}
${lights}${?ground}
  plane { ${ground_normal}, ${ground_offset}
    pigment { rgb ${ground_color} }
    finish { ambient ${ground_ambient} diffuse ${ground_diffuse} }
    #if (!Light_Shadows) no_shadow #end
  }
${/ground}
#end

object {
  Tree
  #if (Tree_Turn != 0) Turn_Tree() #end
  #if (!Tree_Painted) texture { T_Vessel } #end
  interior { I_Vessel }
  #if (!Light_Shadows) no_shadow #end
}
