/* Checks a picture against an answer, or two answers against each other. An answer is a file with
 * certified bounds of each pixel's color. */
#include "job/verify/compare_parts.h"

#include "job/picture/coloring.h"
#include <string.h>

/* Refuses options that have no effect on the comparison with an answer. --output writes the map of
 * distances between a picture and the answer, so it needs a picture, as --background does. */
static Status check(const Parsed *parsed, bool two_answers, Err *err)
{
    for (size_t i = 0; i < parsed->n_settings; i++) {
        const Setting *setting = &parsed->settings[i];
        const char *name = setting->option->name;
        const bool of_picture = strcmp(name, "output") == 0 || strcmp(name, "background") == 0;
        const bool has_effect = setting_is_common(parsed, setting) || strcmp(name, "json") == 0 ||
                                (of_picture && !two_answers);
        if (setting->typed && !has_effect)
            return err_set(err, STATUS_USAGE, "--%s has no effect if A is an answer", name);
    }
    return STATUS_OK;
}

/* Checks the picture B against the answer A. */
static Status grade_picture(const CompareOptions *options, const Parsed *parsed, Comparison *made,
                            Err *err)
{
    const Rgb color = rgb_of_option(options->background);
    const float background[3] = {color.r, color.g, color.b};
    Image image = {0};
    AnswerFile answer = {0};
    Status status;
    TRY_GOTO(answerfile_read(&answer, parsed->operands[0], err));
    TRY_GOTO(image_read(&image, parsed->operands[1], ALPHA_KEPT, NULL, err));
    compare_note_lossy(parsed->operands[1], &image, parsed->common.talk);
    TRY_GOTO(image_composite(&image, background, err));
    status = answergrade_image(&answer, &image, &made->grade,
                               options->heat ? &made->distances : NULL, err);
done:
    answerfile_release(&answer);
    image_release(&image);
    return status;
}

/* Checks the answers A and B against each other. */
static Status grade_answers(const Parsed *parsed, Comparison *made, Err *err)
{
    AnswerFile a = {0}, b = {0};
    Status status;
    TRY_GOTO(answerfile_read(&a, parsed->operands[0], err));
    TRY_GOTO(answerfile_read(&b, parsed->operands[1], err));
    status = answergrade_answers(&a, &b, &made->grade, err);
done:
    answerfile_release(&a);
    answerfile_release(&b);
    return status;
}

Status compare_answer(const CompareOptions *options, const Parsed *parsed, Comparison *made,
                      Err *err)
{
    const bool two_answers = answerfile_is(parsed->operands[1]);
    made->kind = COMPARED_ANSWER;
    Status status = check(parsed, two_answers, err);
    if (status == STATUS_OK)
        status = two_answers ? grade_answers(parsed, made, err)
                             : grade_picture(options, parsed, made, err);
    made->agrees = made->grade.certified; /* false after an error */
    return status;
}

Status compare_write_distances(const char *path, const Comparison *made, Err *err)
{
    Picture picture = {0};
    Status status = answergrade_picture(&made->distances, &picture, err);
    if (status == STATUS_OK)
        status = picture_write(&picture, path, ENCODING_SRGB, NULL, NULL, err);
    picture_release(&picture);
    return status;
}
