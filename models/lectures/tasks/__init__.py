"""What a mechanism is to do: the tasks of synthesis, as a user's file poses them."""
