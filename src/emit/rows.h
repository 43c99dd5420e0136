/* The functions of the output formats. Each row of the table `emitters` describes one format, and
 * points to functions declared here. The comments at the members check_name, write_settings and
 * write of Emitter [emit.h] state what the functions do. Private to the module emit. */
#ifndef CORCAST_EMIT_ROWS_H
#define CORCAST_EMIT_ROWS_H

#include "emit/emit.h"

Status povray_check_name(const char *second_file, Err *err);
Status povray_write_settings(const EmitParams *params, Text *out, Err *err);
Status obj_check_name(const char *second_file, Err *err);

Status blender_write(const EmitParams *params, EmitOutput *to, Err *err);
Status glb_write(const EmitParams *params, EmitOutput *to, Err *err);
Status gmsh_write(const EmitParams *params, EmitOutput *to, Err *err);
Status lattice_write(const EmitParams *params, EmitOutput *to, Err *err);
Status obj_write(const EmitParams *params, EmitOutput *to, Err *err);
Status openscad_write(const EmitParams *params, EmitOutput *to, Err *err);
Status openscad_write_mesh(const EmitParams *params, EmitOutput *to, Err *err);
Status ply_write(const EmitParams *params, EmitOutput *to, Err *err);
Status povray_write(const EmitParams *params, EmitOutput *to, Err *err);
Status povray_write_mesh(const EmitParams *params, EmitOutput *to, Err *err);
Status stl_write(const EmitParams *params, EmitOutput *to, Err *err);
Status stl_write_parts(const EmitParams *params, EmitOutput *to, Err *err);
Status tachyon_write(const EmitParams *params, EmitOutput *to, Err *err);
Status threemf_write(const EmitParams *params, EmitOutput *to, Err *err);
Status usd_write(const EmitParams *params, EmitOutput *to, Err *err);
Status vtp_write_mesh(const EmitParams *params, EmitOutput *to, Err *err);
Status vtu_write_layers(const EmitParams *params, EmitOutput *to, Err *err);

#endif
