"""Bug reports of the field: gathered, labelled, published as ids and labels."""

