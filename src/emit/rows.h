/* The writers that stand in the table of emitters; private to the room. Each as Emitter.write. */
#ifndef CORCAST_EMIT_ROWS_H
#define CORCAST_EMIT_ROWS_H

#include "emit/emit.h"

Status povray_check_name(const char *second_file, Err *err);
Status povray_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                    Err *err);

Status povray_write_settings(const EmitParams *params, Text *out, Err *err);
Status povray_write_mesh(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                         Err *err);

Status openscad_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                      Err *err);
Status openscad_write_mesh(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                           Err *err);

Status tachyon_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                     Err *err);

Status stl_write(const EmitParams *params, Text *out, Text *second, EmitReport *report, Err *err);
Status stl_write_parts(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                       Err *err);
Status vtp_write_mesh(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                      Err *err);
Status ply_write(const EmitParams *params, Text *out, Text *second, EmitReport *report, Err *err);
Status obj_check_name(const char *second_file, Err *err);
Status obj_write(const EmitParams *params, Text *out, Text *second, EmitReport *report, Err *err);
Status threemf_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                     Err *err);
Status glb_write(const EmitParams *params, Text *out, Text *second, EmitReport *report, Err *err);

Status blender_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                     Err *err);
Status usd_write(const EmitParams *params, Text *out, Text *second, EmitReport *report, Err *err);
Status lattice_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                     Err *err);

/* [x,y,z], as OpenSCAD reads a point. */
void put_point(Text *text, Vec3 v);

#endif
