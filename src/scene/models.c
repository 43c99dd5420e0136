/* Lists the models, the ways in which vessels are drawn, with their names and properties. Both
 * tables are built from MODEL_TABLE. */
#include "scene/models.h"

#include <stdio.h>
#include <string.h>

const Model models[SCENE_MODELS] = {
#define X(symbol, named, described, has, held)                                                     \
    [SCENE_##symbol] = {                                                                           \
        .name = named, .description = described, .properties = has, .proof = PROOF_##held},
    MODEL_TABLE(X)
#undef X
};

const char *const model_names[] = {
#define X(symbol, named, described, has, held) named,
    MODEL_TABLE(X)
#undef X
        NULL};

SceneModel model_with(unsigned properties)
{
    SceneModel model = 0;
    while (!model_has(model, properties))
        model++;
    return model;
}

/* Names the models that have any of the properties and no other elements than those allowed. */
static ModelNames list_models(unsigned properties, unsigned allowed)
{
    bool listed[SCENE_MODELS];
    int left = 0;
    ModelNames names = {""};
    for (int i = 0; i < SCENE_MODELS; i++) {
        listed[i] = model_has((SceneModel)i, properties) && model_is_of((SceneModel)i, allowed);
        left += listed[i];
    }
    for (int i = 0; i < SCENE_MODELS; i++) {
        size_t length = strlen(names.text);
        if (listed[i])
            snprintf(names.text + length, sizeof names.text - length, "%s%s", models[i].name,
                     --left == 0 ? ""
                     : left == 1 ? " and "
                                 : ", ");
    }
    return names;
}

ModelNames models_with(unsigned properties)
{
    return list_models(properties, MODEL_ELEMENTS);
}

ModelNames models_of(unsigned elements)
{
    return list_models(MODEL_ELEMENTS, elements);
}
