// A grown arterial tree as a cast of translucent resin on a sweep of warm paper: a soft key light, a rim light from behind,
// light that bounces between the vessels (radiosity), light that enters them (subsurface), and a lens that is focused on
// the nearest branches.
//
//   make hero                # out/hero/hero.png, 1600 x 1600
//   make hero HERO_SIZE=400  # smaller
//
// docs/examples/hero has its commands. Declare=Hero_Quality=0 draws a draft. POV-Ray calls subsurface experimental
// whenever a scene uses it.
#version 3.7;
#ifndef (Hero_Quality) #declare Hero_Quality = 1; #end

#include "hero.inc"
#declare R = Tree_Radius / sqrt(3); // of the ball that the tree fills

global_settings {
  assumed_gamma 1.0
  max_trace_level 6
  mm_per_unit 1
  radiosity {
    pretrace_start 0.08 pretrace_end (Hero_Quality ? 0.02 : 0.08)
    count (Hero_Quality ? 20 : 15) nearest_count 8 error_bound 0.6 recursion_limit 1 brightness 1
  }
  subsurface { samples 2, 1 }
}

// The tree stands on its root: the root is at the origin, and the ball is above it.
#declare Middle = R * y;
#declare Eye = Middle + R * <0.55, 0.42, 5>;
camera {
  location Eye
  right -image_width / image_height * x // right-handed, as the tree is
  look_at Middle - 0.06 * R * y
  angle 24
  aperture 0.1 * R focal_point Middle + R * <0.1, 0, 0.75>
  blur_samples (Hero_Quality ? 5 : 4) variance 1 / 2000 confidence 0.9
}

#macro Soft_Light(Place, Color, Size)
  light_source {
    Middle + R * Place, rgb Color
    #if (Size > 0)
      area_light vnormalize(vcross(Place, y)) * Size * R, vnormalize(vcross(vcross(Place, y), Place)) * Size * R,
        5, 5 adaptive 1 jitter
    #end
  }
#end
#macro Soft_Lights(Size)
  Soft_Light(<-2.6, 4.2, 3>, 0.8 * <1, 0.96, 0.9>, 1.6 * Size)
  Soft_Light(<3.2, 1.8, -3.4>, 0.55 * <1, 0.78, 0.55>, Size) // from behind, through the vessels
#end
Soft_Lights(1)

background { rgb <0.6, 0.56, 0.5> }
// The sweep: a floor that bends up into a wall behind the tree.
union {
  plane { y, 0 clipped_by { plane { -z, 3 * R } } }
  cylinder { -1e4 * x, 1e4 * x, 6 * R open translate <0, 6 * R, -3 * R>
    clipped_by { intersection { plane { z, -3 * R } plane { y, 6 * R } } } }
  plane { -z, 9 * R clipped_by { plane { -y, -6 * R } } }
  texture { pigment { rgb <0.62, 0.57, 0.50> } finish { ambient 0 diffuse 0.85 } }
}

light_group {
  Soft_Lights(0)
  object {
  Tree
  translate -Root_Position
  rotate 180 * z
  rotate 25 * y
  texture {
    pigment { rgb <0.72, 0.05, 0.03> }
    finish {
      ambient 0 diffuse 0.7
      specular 0.55 roughness 0.012
      subsurface { translucency <0.5, 0.3, 0.2> }
    }
  }
  interior { ior 1.45 }
  }
  global_lights off
}
