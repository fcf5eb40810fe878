"""The budget of an error: what is named, what more could be predicted, what could not.

repeats    what differs between strokes or periods that are repeated
library    what a flexible predictor with memory may look at
ceiling    how well it predicts what a model leaves, on data that it has not seen
words      the budget in figures and in a sentence
"""
