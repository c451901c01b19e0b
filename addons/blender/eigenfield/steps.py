"""Operators that take long: with a window step by step, so that Blender shows how far they are and Esc stops them."""

import time

from .program import RefusalError

TIMER_SECONDS = 0.02  # between two steps


class Stepped:
    """An operator whose `steps(context)` yield what part is done, from 0 to 1, and a few words."""

    def execute(self, context):
        try:
            for _ in self.steps(context):
                time.sleep(0.005)  # a step may wait for another program
        except (RefusalError, OSError, ValueError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        self.work = self.steps(context)
        self.timer = context.window_manager.event_timer_add(TIMER_SECONDS, window=context.window)
        context.window_manager.progress_begin(0, 1)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            return self.end(context, {"CANCELLED"})
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        try:
            part, words = next(self.work)
        except StopIteration:
            return self.end(context, {"FINISHED"})
        except (RefusalError, OSError, ValueError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return self.end(context, {"CANCELLED"})
        context.window_manager.progress_update(part)
        context.workspace.status_text_set(f"{self.bl_label}: {part:.0%}, {words}. Esc stops it")
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Called by Blender where it ends the operator: another file is opened, or Blender is left."""
        self.end(context, {"CANCELLED"})

    def end(self, context, result):
        self.work.close()
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        return result
