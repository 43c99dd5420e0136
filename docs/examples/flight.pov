// A flight along the main branch of a tree, over its vessels, from the root to the end of the branch
// while clock goes from 0 to 1. It takes tree.inc of the folder it is drawn in.
//
//   povray +Iflight.pov +Oflight.png +W800 +H600 +A0.3 -D +KFI1 +KFF120
#version 3.7;
#ifndef (Tree_File)  #declare Tree_File  = "tree.inc"; #end
#ifndef (Flight_High) #declare Flight_High = 0.12; #end // above the vessels, parts of Tree_Radius
#ifndef (Flight_Ahead) #declare Flight_Ahead = 0.15; #end // how far ahead it looks, parts of the branch
#include Tree_File

global_settings { assumed_gamma 1.0 }
#declare Here = Path_At(clock * (1 - Flight_Ahead));
#declare There = Path_At(clock * (1 - Flight_Ahead) + Flight_Ahead);
camera {
  location Here + <0, 0, Flight_High> * Tree_Radius
  sky z
  right -image_width / image_height * x // right-handed, as the tree is
  look_at There
  angle 70
}
background { rgb <0.9, 0.93, 0.97> }
light_source { Tree_Center + <-1, 1, 3> * Tree_Radius, rgb 1 parallel point_at Tree_Center }
object { Tree #if (!Tree_Painted) texture { T_Vessel } #end interior { I_Vessel } }
