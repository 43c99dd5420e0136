// Persistence of Vision Ray Tracer Scene Description File
// File: ${file}
// Vers: 3.7
// Desc: ${description}
// Auth: ${generator}, by: ${command}
//
// A glow in the shape of vessels. The density of the medium, from ${density_file}, is the fraction of each voxel that
// vessels fill. Units are millimetres. Seen from the front, x points to the right, y up, and z towards the viewer.
// Extent: ${extent}
//
// Render: povray +I${input} +O${output} +W${width} +H${height} -D
// Size: ${width}x${height}
//
// Every value inside #ifndef can be declared before an #include of this file. Numbers can also be set on the command
// line: Declare=Glow_Emission=2. The color of a pixel is Glow_Color * Glow_Emission * the millimetres of vessel on its ray.
#version 3.7;

global_settings { assumed_gamma 1.0 max_trace_level 5 }

#ifndef (Glow_Color)       #declare Glow_Color       = rgb <1, 0.42, 0.18>; #end // linear
#ifndef (Glow_Emission)    #declare Glow_Emission    = ${emission}; #end // light per mm of vessel
#ifndef (Glow_Absorption)  #declare Glow_Absorption  = 0; #end // absorption of the light behind, per mm of vessel
#ifndef (Glow_Interpolate) #declare Glow_Interpolate = 1; #end // 0: voxels are boxes; 1: linear interpolation
#ifndef (Glow_Samples)     #declare Glow_Samples     = ${samples}; #end // samples along a ray through the box
#ifndef (Background_Color) #declare Background_Color = rgb <0.004, 0.006, 0.012>; #end

#declare Glow_Low  = ${low};
#declare Glow_High = ${high};
#declare Glow_Size = Glow_High - Glow_Low;
#declare Glow_Center = (Glow_Low + Glow_High) / 2;

// ---- camera ---------------------------------------------------------------------------------
#local Picture_Width  = image_width;
#local Picture_Height = image_height;
${camera}camera {
  #if (Camera_Perspective) perspective #else orthographic #end
  location  Camera_Location
  direction Camera_Direction
  right     Camera_Right
  up        Camera_Up
}
background { color Background_Color }

// ---- vessels --------------------------------------------------------------------------------
#declare D_Vessels = density {
  density_file df3 "${density_file}"
  interpolate Glow_Interpolate
  scale Glow_Size
  translate Glow_Low
}
#declare I_Glow = interior {
  media {
    emission   Glow_Color * Glow_Emission
    absorption rgb Glow_Absorption
    method 2 // the mean of evenly spaced samples; method 3 is less exact
    intervals 1
    samples Glow_Samples
    density { D_Vessels }
  }
}
#ifndef (Glow_Alone)
  box {
    Glow_Low, Glow_High
    hollow
    texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 } }
    interior { I_Glow }
  }
#end
