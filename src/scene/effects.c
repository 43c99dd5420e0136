/* Lists the effects of a picture by name, for messages. The names are the words of their options.
 */
#include "scene/effects.h"

void effects_list(const Effects *effects, bool occlusion, Text *out)
{
    const struct {
        bool present;
        const char *name;
    } all[] = {{effects->outline.width_px > 0, "outlines"},
               {effects->halo.width_px > 0, "halos"},
               {effects->grade.present, "a graded background"},
               {occlusion, "ambient occlusion"},
               {effects->xray.per_mm > 0, "x-ray"}};
    int left = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        left += all[i].present;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i].present)
            text_printf(out, "%s%s", all[i].name, --left == 0 ? "" : left == 1 ? " and " : ", ");
}
