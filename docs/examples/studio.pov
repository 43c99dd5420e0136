// A tree in a studio: a soft key light, a pale sweep behind it, light that bounces, flesh that light
// enters, a glass ball, and a lens that blurs what is not at the tree's own distance.
//
//   povray +Istudio.pov +Ostudio.png +W800 +H600 +A0.3 -D
//
// It takes tree.inc of the folder it is drawn in, of any tree and model. Numbers can be set with
// Declare=Name=number; Studio_Blur=0 is a quick draft.
#version 3.7;
#ifndef (Tree_File)   #declare Tree_File   = "tree.inc"; #end
#ifndef (Studio_Skin) #declare Studio_Skin = 0; #end // 1: light enters the vessels; minutes, and POV-Ray calls it experimental
#ifndef (Studio_Blur) #declare Studio_Blur = 24; #end // rays through the lens for each pixel; 0: sharp
#ifndef (Studio_Turn) #declare Studio_Turn = 360 * clock; #end // degrees about the tree

#include Tree_File
#declare Unit = Tree_Radius;
#declare Floor = Tree_Min.y - 0.05 * Unit;

global_settings {
  assumed_gamma 1.0
  max_trace_level 12
  mm_per_unit 60 / Unit // the tree stands as one of 12 cm
  radiosity {
    pretrace_start 0.08 pretrace_end 0.01
    count 120 nearest_count 8 error_bound 0.5 recursion_limit 1 brightness 0.8
  }
  #if (Studio_Skin) subsurface { samples 8, 2 } #end
}

#declare Eye = Tree_Center + vrotate(<0.25, 0.3, 3.1> * Unit, y * Studio_Turn);
camera {
  location Eye
  right -image_width / image_height * x // right-handed, as the tree is
  look_at Tree_Center
  angle 42
  #if (Studio_Blur)
    aperture 0.05 * Unit focal_point Tree_Center blur_samples Studio_Blur variance 1 / 1000
  #end
}

background { rgb 0.6 }
light_source {
  Tree_Center + <-2, 3, 2.5> * Unit, rgb 0.8
  area_light <0.8, 0, 0.6> * Unit, <0, 1, 0> * Unit, 4, 4 adaptive 1
}
plane {
  y, Floor
  texture { pigment { rgb <0.82, 0.84, 0.86> } finish { ambient 0 diffuse 0.8 } }
}

object {
  Tree
  #if (!Tree_Painted)
    texture {
      pigment { rgb <0.75, 0.12, 0.08> }
      finish {
        ambient 0 diffuse 0.75 specular 0.4 roughness 0.02
        #if (Studio_Skin) subsurface { translucency <0.6, 0.15, 0.1> } #end
      }
    }
  #end
  interior { ior 1.4 }
}

sphere {
  <Tree_Center.x + 0.6 * Unit, Floor + 0.22 * Unit, Tree_Center.z + 0.4 * Unit>, 0.22 * Unit
  texture {
    pigment { rgbf <0.95, 0.98, 1, 0.95> }
    finish { ambient 0 diffuse 0.02 specular 0.6 roughness 0.005 reflection { 0.03, 0.6 fresnel } conserve_energy }
  }
  interior { ior 1.5 }
}
