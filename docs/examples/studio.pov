// A tree in a studio: a soft key light, a pale sweep behind it, light that bounces between them, flesh that
// light enters, balls of glass, and a lens that blurs what is not at the tree's own distance.
//
//   povray +Istudio.pov +Ostudio.png +W320 +H240 -D
//
// It takes tree.inc of the folder it is drawn in, of any tree and model; light enters blob and isosurface
// best, which have no walls inside. Numbers can be set with Declare=Name=number; any of the five at 0 makes
// a quicker draft. POV-Ray calls subsurface experimental whenever a scene uses it.
#version 3.7;
#ifndef (Tree_File)     #declare Tree_File     = "tree.inc"; #end
#ifndef (Studio_Soft)   #declare Studio_Soft   = 4; #end // lights along a side of each area light
#ifndef (Studio_Bounce) #declare Studio_Bounce = 1; #end // radiosity
#ifndef (Studio_Skin)   #declare Studio_Skin   = 1; #end // light enters the vessels
#ifndef (Studio_Glass)  #declare Studio_Glass  = 1; #end // balls of glass beside the tree
#ifndef (Studio_Blur)   #declare Studio_Blur   = 8; #end // rays through the lens for each pixel
#ifndef (Studio_Turn)   #declare Studio_Turn   = 360 * clock; #end // degrees about the tree

#include Tree_File
#declare Unit = Tree_Radius;
#declare Floor = Tree_Min.y - 0.05 * Unit;

global_settings {
  assumed_gamma 1.0
  max_trace_level 12
  mm_per_unit 60 / Unit // the tree stands as one of 12 cm
  #if (Studio_Bounce)
    radiosity {
      pretrace_start 0.08 pretrace_end 0.01
      count 60 nearest_count 6 error_bound 0.5 recursion_limit 1 brightness 0.8
    }
  #end
  #if (Studio_Skin) subsurface { samples 6, 1 } #end
}

#declare Eye = Tree_Center + vrotate(<0.25, 0.3, 3.1> * Unit, y * Studio_Turn);
camera {
  location Eye
  right -image_width / image_height * x // right-handed, as the tree is
  look_at Tree_Center - 0.08 * Unit * y
  angle 36
  #if (Studio_Blur)
    aperture 0.16 * Unit focal_point Tree_Center blur_samples Studio_Blur variance 1 / 1000
  #end
}

background { rgb 0.5 }
#macro Studio_Light(Place, Color)
  light_source {
    Tree_Center + Place * Unit, rgb Color
    #if (Studio_Soft)
      area_light vnormalize(vcross(Place, y)) * Unit, y * Unit, Studio_Soft, Studio_Soft adaptive 1
    #end
  }
#end
Studio_Light(<-2, 3, 2.5>, 0.5)
Studio_Light(<1.6, 2.2, -3>, <0.4, 0.38, 0.35>) // from behind, through the vessels
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
        #if (Studio_Skin) subsurface { translucency <2.4, 0.4, 0.25> } #end
      }
    }
  #end
  interior { ior 1.4 }
}

#macro Glass_Ball(X, Z, R)
  sphere {
    <Tree_Center.x + X * Unit, Floor + R * Unit, Tree_Center.z + Z * Unit>, R * Unit
    texture {
      pigment { rgbf <0.95, 0.98, 1, 0.95> }
      finish { ambient 0 diffuse 0.02 specular 0.6 roughness 0.005 reflection { 0.03, 0.6 fresnel } conserve_energy }
    }
    interior { ior 1.5 }
  }
#end
#if (Studio_Glass)
  Glass_Ball(0.6, 0.3, 0.22)
  Glass_Ball(0.25, -1.6, 0.2) // behind the tree, out of focus
  Glass_Ball(-0.9, -2.6, 0.25)
#end
